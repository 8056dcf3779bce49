#include "heat/heat_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"

namespace suite {

namespace {

// K, by which points may be warmer or colder than all elements.
constexpr double kPointsBeyond = 60;

}  // namespace

HeatField::HeatField(std::shared_ptr<const Elements> elements, std::shared_ptr<const HeatResult> result,
                     std::shared_ptr<const PointHeat> points)
    : elements_(std::move(elements)), result_(std::move(result)), points_(std::move(points)) {
  const auto [low, high] = std::minmax_element(result_->kelvin.begin(), result_->kelvin.end());
  const auto [cold, warm] = std::minmax_element(result_->air_kelvin.begin(), result_->air_kelvin.end());
  range_ = {double{std::min(*low, *cold)}, double{std::max(*high, *warm)}};
  if (points_) range_ = {std::max(range_[0] - kPointsBeyond, range_[0] / 2), range_[1] + kPointsBeyond};
}

double HeatField::kelvin(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material, time);
  if (!element) return result_->air_at(time);
  const double kelvin = result_->kelvin_at(*element, time);
  if (!points_ || !points_->tells(*element, time)) return kelvin;
  return std::clamp(kelvin + points_->above(*element, place, time).value_or(0), range_[0], range_[1]);
}

double HeatField::error(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material, time);
  if (!element) return NAN;
  HeatErrors errors = result_->errors_at(*element, time);
  // Points that do not settle have their element's temperature, and its error.
  if (points_ && points_->tells(*element, time) && points_->above(*element, place, time)) errors.size = 0;
  return errors.total();
}

ExplainedField::Cause HeatField::cause(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material, time);
  if (!element) return {};
  const auto at = [&](const std::vector<float>& rows) {
    if (rows.empty()) return double{NAN};
    return result_->between_moments({&rows[*element * result_->moments], result_->moments}, time);
  };
  return {double{result_->sun_hours[*element]}, at(result_->absorbed), at(result_->received)};
}

namespace {

struct Head {
  double begin, end, step, sweep_error, past_error;
  uint64_t periodic, moments, faces, points, fluxes;
};

template <class Value>
std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
  return std::as_bytes(std::span(values));
}

// What of a result travels, besides its head.
constexpr std::vector<float> HeatResult::*kRows[] = {
    &HeatResult::kelvin,    &HeatResult::path_error, &HeatResult::size_error, &HeatResult::step_error,
    &HeatResult::absorbed,  &HeatResult::received,   &HeatResult::straight,   &HeatResult::emissivity,
    &HeatResult::sun_hours, &HeatResult::air_kelvin};

}  // namespace

std::vector<std::byte> packed_field(const HeatResult& r) {
  const std::vector<Head> head{{r.span.begin, r.span.end, r.step, r.sweep_error, r.past_error, r.periodic, r.moments,
                                r.kelvin.size() / r.moments, !r.straight.empty(), !r.absorbed.empty()}};
  size_t size = bytes_of(head).size(), at = 0;
  for (const auto rows : kRows) size += bytes_of(r.*rows).size();
  std::vector<std::byte> out(size);
  const auto add = [&](std::span<const std::byte> bytes) {
    if (!bytes.empty()) std::memcpy(&out[at], bytes.data(), bytes.size());
    at += bytes.size();
  };
  add(bytes_of(head));
  for (const auto rows : kRows) add(bytes_of(r.*rows));
  return out;
}

HeatResult unpacked_field(std::span<const std::byte> bytes) {
  const auto take = [&](void* to, size_t count) {
    SUITE_CHECK(count <= bytes.size());
    if (count > 0) std::memcpy(to, bytes.data(), count);
    bytes = bytes.subspan(count);
  };
  Head head{};
  take(&head, sizeof head);
  HeatResult r;
  r.span = {head.begin, head.end}, r.step = head.step, r.periodic = head.periodic != 0, r.moments = head.moments;
  r.sweep_error = head.sweep_error, r.past_error = head.past_error;
  r.kelvin.resize(head.faces * r.moments);
  for (auto* values : {&r.absorbed, &r.received}) values->resize(head.fluxes ? r.kelvin.size() : 0);
  for (auto* values : {&r.path_error, &r.size_error, &r.step_error}) values->resize(head.faces * kHeatParts);
  for (auto* values : {&r.emissivity, &r.sun_hours}) values->resize(head.faces);
  r.straight.resize(head.points ? r.kelvin.size() : 0), r.air_kelvin.resize(r.moments);
  for (const auto rows : kRows) take((r.*rows).data(), (r.*rows).size() * sizeof(float));
  return r;
}

}  // namespace suite
