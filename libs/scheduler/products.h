// Which products of the spectra that a sensor sees count when its bins are chosen, and their values over any bins.
#pragma once
#include "scheduler/seen_spectra.h"
#include "spectral/cubature.h"

namespace suite {

// How many of the factors that are most unlike each other are multiplied with each other.
struct ProductDepth {
  size_t pairs = 8, triples = 4, powers = 4;
  size_t through_gases = 4;  // each alone, of light that gases have absorbed on its way
};

class ProductRecipe {
 public:
  ProductRecipe() = default;
  // Spectra of one shape, seen over the bins of a state (in any order), count once. white_light: a source of unit
  // radiance shines as well; it does in any case when nothing else does.
  ProductRecipe(const std::vector<SeenSpectra>& seen, const SpectralState& state, bool white_light,
                const ProductDepth& depth = {});
  SpectralProducts over(const SpectralState& state) const;
  // "the sun on reflectance of asphalt"; empty when there is no such product.
  std::string name_of(size_t product) const;

 private:
  struct Power {
    uint32_t of;
    int exponent;
  };
  using Rows = std::vector<std::vector<float>>;
  void list_through_gases(uint32_t light);
  void keep(const std::vector<SeenSpectra>& seen, const SpectralState& state);
  void choose_leaders(const std::vector<std::vector<float>>& spectra);
  void list_products(bool white_light);
  Rows values(const SpectralState& state) const;
  Rows unabsorbed(const SpectralState& state) const;
  bool any_kept(size_t row, size_t rows) const;

  ProductDepth depth_;
  std::vector<SeenSpectra> seen_;
  std::vector<bool> kept_;          // of each row of seen_, one after the other
  std::vector<SpectrumRole> role_;  // of the kept ones
  std::vector<bool> absorbed_;      // by gases
  std::vector<std::string> name_;
  std::vector<uint32_t> leaders_;  // factors that are most unlike each other: they are multiplied with each other
  std::vector<Power> powers_;      // stand behind the kept ones
  std::vector<SpectralProducts::Product> products_;
};

}  // namespace suite
