// One line per model file: the row it adds to the table in models.cpp.
#pragma once
#include "optics/models.h"

namespace suite {

ModelRow lambert_row();
ModelRow mirror_row();
ModelRow ward_row();
ModelRow sqt_row();

}  // namespace suite
