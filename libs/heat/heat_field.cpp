#include "heat/heat_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"

namespace suite {

HeatField::HeatField(std::shared_ptr<const Elements> elements, std::shared_ptr<const HeatResult> result)
    : elements_(std::move(elements)), result_(std::move(result)) {
  const auto [low, high] = std::minmax_element(result_->kelvin.begin(), result_->kelvin.end());
  const auto [cold, warm] = std::minmax_element(result_->air_kelvin.begin(), result_->air_kelvin.end());
  range_ = {double{std::min(*low, *cold)}, double{std::max(*high, *warm)}};
}

double HeatField::kelvin(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material);
  return element ? result_->kelvin_at(*element, time) : result_->air_at(time);
}

double HeatField::error(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material);
  return element ? result_->errors_at(*element, time).total() : NAN;
}

namespace {

struct Head {
  double begin, end, step, sweep_error, past_error;
  uint64_t periodic, moments, faces;
};

template <class Value>
std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
  return std::as_bytes(std::span(values));
}

}  // namespace

std::vector<std::byte> packed_field(const HeatResult& r) {
  const std::vector<Head> head{{r.span.begin, r.span.end, r.step, r.sweep_error, r.past_error, r.periodic, r.moments,
                                r.kelvin.size() / r.moments}};
  std::vector<std::byte> out;
  for (const auto bytes : {bytes_of(head), bytes_of(r.kelvin), bytes_of(r.path_error), bytes_of(r.size_error),
                           bytes_of(r.step_error), bytes_of(r.air_kelvin)})
    out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

HeatResult unpacked_field(std::span<const std::byte> bytes) {
  const auto take = [&](void* to, size_t count) {
    SUITE_CHECK(count <= bytes.size());
    std::memcpy(to, bytes.data(), count);
    bytes = bytes.subspan(count);
  };
  Head head{};
  take(&head, sizeof head);
  HeatResult r;
  r.span = {head.begin, head.end}, r.step = head.step, r.periodic = head.periodic != 0, r.moments = head.moments;
  r.kelvin.resize(head.faces * r.moments), r.path_error.resize(head.faces * kHeatParts);
  r.size_error.resize(r.path_error.size()), r.step_error.resize(r.path_error.size());
  r.air_kelvin.resize(r.moments), r.sweep_error = head.sweep_error, r.past_error = head.past_error;
  for (auto* values : {&r.kelvin, &r.path_error, &r.size_error, &r.step_error, &r.air_kelvin})
    take(values->data(), values->size() * sizeof(float));
  return r;
}

}  // namespace suite
