#include "formats/motion/motion.h"
#include "math/sampling.h"

namespace suite {

namespace {

// One axis: {sigma_m: 0.01} is white, {psd: {...}} is coloured; mean_m goes with both. `unit` is m or rad.
AxisJitter axis_from(const Params& node, const std::string& unit) {
  AxisJitter a;
  a.mean = node.number("mean_" + unit, 0);
  const auto sigma = node.find("sigma_" + unit), psd = node.find("psd");
  if (sigma.has_value() == psd.has_value())
    throw node.error("an axis of jitter is either white or has a power spectral density",
                     "give sigma_" + unit + " or psd");
  if (sigma) {
    a.kind = AxisJitter::Kind::white;
    a.sigma = sigma->as_number_in(0, 1e6, unit.c_str());
    return a;
  }
  a.kind = AxisJitter::Kind::psd;
  auto between = Psd::Between::log_log;
  if (const auto b = psd->find("between"))
    between = b->as_choice({"log_log", "linear"}) == 0 ? Psd::Between::log_log : Psd::Between::linear;
  const std::string column = "density_" + unit + "2_hz";
  if (const auto file = psd->find("file")) {
    a.psd = read_psd(file->as_path(), column, between);
    return a;
  }
  a.psd = {psd->at("frequency_hz").as_numbers(), psd->at(column).as_numbers(), between};
  try {
    a.psd.check();
  } catch (const Error& e) {
    throw psd->error(e.message(), e.hint());
  }
  return a;
}

}  // namespace

Jitter jitter_from(const Params& node, uint64_t seed) {
  constexpr const char* kAxes[] = {"x", "y", "z", "rotate_x", "rotate_y", "rotate_z"};
  std::array<AxisJitter, 6> axes;
  for (int i = 0; i < 6; ++i)
    if (const auto axis = node.find(kAxes[i])) axes[i] = axis_from(*axis, i < 3 ? "m" : "rad");
  const auto own = static_cast<uint64_t>(node.integer("seed", 0, 1LL << 52, 0));
  return Jitter(axes, hash_of(seed, own), static_cast<int>(node.integer("components", 16, 4096, 256)));
}

}  // namespace suite
