// The multiplication register of an electron-multiplying CCD.
#pragma once
#include "base/params.h"
#include "math/sampling.h"

namespace suite {

// In each of its stages an electron makes a second one with a small probability. The number behind them is a branching
// process. Based on: M. S. Robbins, B. J. Hadwen, "The noise performance of electron multiplying charge-coupled
// devices", IEEE Trans. Electron Devices 50, 2003; T. E. Harris, "The Theory of Branching Processes", 1963, chapter I
// (mean and variance).
class Register {
 public:
  // stages >= 1; probability: of one stage, 0..0.5.
  Register(int stages, double probability) : stages_(stages), p_(probability) {}
  double gain() const { return gain_of(stages_); }
  // Variance of one electron's output over the square of its mean, plus one: 1 + (1 - p) / (1 + p) (1 - 1 / G).
  double excess() const { return 1 + spread_of(stages_); }
  int stages() const { return stages_; }
  // Electrons behind the register for so many in front of it (a whole number >= 0). Exact while there are fewer than
  // kMany, then a gamma variate with the mean and the variance of the stages that are left.
  double multiply(double electrons, Pcg32& random) const { return pass(electrons, stages_, random); }
  // Of one electron that appears in front of the last `left` stages.
  double from_stage(int left, Pcg32& random) const { return pass(1, left, random); }

 private:
  static constexpr double kMany = 48;
  double pass(double electrons, int left, Pcg32& random) const;
  double gain_of(int stages) const;
  double spread_of(int stages) const { return (1 - p_) / (1 + p_) * (1 - 1 / gain_of(stages)); }
  int stages_;
  double p_;
};

// Keys of the register and what comes into it: stages, em_gain | stage_probability, clock_induced_e,
// serial_clock_induced_e, register_full_well_e, read_noise_e.
struct RegisterKeys {
  Register stages{1, 0};
  double clock_induced = 0;         // electrons a read-out, made before the register
  double serial_clock_induced = 0;  // made in it, at any stage
  double full_well = 0;             // electrons behind the register; 0 = no limit
  double read_noise = 0;            // electrons behind the register
  // Electrons behind the register, without read noise, for so many before it.
  double charge(double electrons, Pcg32& random) const;
  // Mean gain of what is made in the register, at a stage that may be any.
  double serial_gain() const;
};
RegisterKeys read_register(const Params& p);

}  // namespace suite
