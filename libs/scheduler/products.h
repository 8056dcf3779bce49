// Which products of the spectra that a sensor sees count when its bins are chosen, and their values over any bins.
#pragma once
#include "scheduler/seen_spectra.h"
#include "spectral/cubature.h"

namespace suite {

class ProductRecipe {
 public:
  ProductRecipe() = default;
  // Spectra of one shape, seen over the bins of a state (in any order), count once. white_light: a source of unit
  // radiance shines as well; it does in any case when nothing else does.
  ProductRecipe(const std::vector<SeenSpectra>& seen, const SpectralState& state, bool white_light);
  SpectralProducts over(const SpectralState& state) const;
  // "the sun on reflectance of asphalt"; empty when there is no such product.
  std::string name_of(size_t product) const;

 private:
  struct Power {
    uint32_t of;
    int exponent;
  };
  void keep(const std::vector<SeenSpectra>& seen, const SpectralState& state);
  void choose_leaders(const std::vector<std::vector<float>>& spectra);
  void list_products(bool white_light);
  std::vector<std::vector<float>> values(const SpectralState& state) const;

  std::vector<SeenSpectra> seen_;
  std::vector<bool> kept_;          // of each row of seen_, one after the other
  std::vector<SpectrumRole> role_;  // of the kept ones
  std::vector<std::string> name_;
  std::vector<uint32_t> leaders_;  // factors that are most unlike each other: they are multiplied with each other
  std::vector<Power> powers_;      // stand behind the kept ones
  std::vector<SpectralProducts::Product> products_;
};

}  // namespace suite
