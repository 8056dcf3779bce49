// One thread's walks through the balance of heat (heat_audit.h).
#pragma once
#include "heat/audit_sun.h"
#include "heat/heat_audit.h"

namespace suite {

// What walks look up: the columns behind faces, loads and temperatures as found, at any time.
class AuditTables {
 public:
  AuditTables(const AuditedScene& scene, const SolvedSurfaces& solved);

  struct Column {  // of a group
    const SurfaceGroup* group;
    std::vector<double> capacity, conductance, source;  // by node, by interval, by node; none without heat capacity
  };
  struct Behind {  // of a face
    uint32_t group, element;
    bool back;
  };
  const Column& column(uint32_t group) const { return columns_[group]; }
  const Behind& behind(uint32_t face) const { return behind_[face]; }
  // Within the span, s.
  double wrapped(double t) const;
  double kelvin(uint32_t face, double t) const {
    return between_moments([&](size_t k) { return solved_.history.kelvin_at(face, k); }, t);
  }
  double absorbed(uint32_t face, double t) const { return at(solved_.loads.absorbed, face, t); }
  double mirrored(uint32_t face, double t) const;
  double outside(uint32_t number, double t) const { return at(solved_.loads.outside, number, t); }  // W/m2
  double received(uint32_t face, double t) const { return at(solved_.history.received, face, t); }
  double source(uint32_t face) const { return solved_.loads.source.empty() ? 0 : solved_.loads.source[face]; }
  FaceTraits traits(uint32_t face) const;
  FaceWeather air(double t) const;
  double step() const { return step_; }
  double reference() const { return reference_; }  // K, that walks count from

 private:
  double position(double t) const;
  template <class Of>
  double between_moments(const Of& of, double t) const {  // of(moment)
    const double x = position(t);
    const auto k = std::min(static_cast<size_t>(x), moments_ - 2);
    return of(k) + (of(k + 1) - of(k)) * (x - static_cast<double>(k));
  }
  double at(const CompactRows& rows, size_t row, double t) const {
    return between_moments([&](size_t k) { return rows.at(row, k); }, t);
  }
  template <class Value>
  double at(const std::vector<Value>& rows, size_t row, double t) const {
    return between_moments([&](size_t k) { return static_cast<double>(rows[row * moments_ + k]); }, t);
  }

  const SolvedSurfaces& solved_;
  size_t moments_;
  double begin_, end_, past_, step_, reference_ = 0;
  std::vector<Column> columns_;
  std::vector<Behind> behind_;
};

class AuditWalk {
 public:
  AuditWalk(const AuditedScene& scene, const SolvedSurfaces& solved, const AuditTables& tables);
  struct Found {
    double kelvin = 0;  // of a place of a face
    double more = 0;    // K, than its element has
  };
  Found follow(const Hit& hit, uint32_t face, double t, WalkNumbers& numbers);
  double rays() const { return sun_.rays() + static_cast<double>(trace_.rays); }
  size_t cut() const { return cut_; }
  size_t fast() const { return fast_; }

 private:
  struct Side {  // of a face at a time, W/(m2 K) and W/m2
    uint32_t face = 0;
    double found = 0;      // K
    double radiation = 0;  // of black paths
    double air = 0, air_kelvin = 0, constant = 0;
    double rate() const { return radiation + air; }
  };
  Side side(uint32_t face) const;
  void gather(const Side& side, double rates, WalkNumbers& numbers);
  bool at_surface(WalkNumbers& numbers);
  bool massless(WalkNumbers& numbers);
  void within(WalkNumbers& numbers);
  bool leave_by(const Side& side, double u, WalkNumbers& numbers);
  bool radiate(const Side& side, WalkNumbers& numbers);
  bool arrive(const Side& side, uint32_t end, const Hit& hit, double path_weight);
  void enter(uint32_t face, const Hit& hit);
  uint32_t face_of(bool back) const;

  const AuditedScene& scene_;
  const AuditTables& tables_;
  AuditSun sun_;
  Surface surface_;
  OneBinWalk bins_;
  Interaction at_;
  std::vector<float> W_;
  TraceStatistics trace_;
  size_t cut_ = 0, fast_ = 0;
  // The walk.
  Hit hit_;
  AuditTables::Behind column_{};
  size_t node_ = 0;
  double t_ = 0, weight_ = 1, sum_ = 0, more_ = 0;
};

}  // namespace suite
