// Decks of LOWTRAN and MODTRAN computed with the air of this suite (--air DECK), beside their own spectra (--against).
#pragma once
#include <string>

namespace suite {

// By its name: .tp5, .ltn, .tape5, or tape5 with anything behind it.
bool is_deck(const std::string& path);

// For each run of the deck and each of at most 50 intervals of its band: transmittance, the path's radiance and the
// transmittance from the Sun to the path's end and back, or of mode 3 the Sun's irradiance; with `against` (tape7, or
// .json of MODTRAN 6; "" = none), the same of it and the differences. Error: as read_tape5 and read_tape7; runs that
// are not those of the deck; what our air does not have.
std::string deck_text(const std::string& deck, const std::string& against);

}  // namespace suite
