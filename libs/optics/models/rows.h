// One line per model file: the row it adds to the table in models.cpp.
#pragma once
#include "optics/models.h"

namespace suite {

ModelRow lambert_row();
ModelRow mirror_row();
ModelRow ward_row();
ModelRow ggx_row();
ModelRow ggx_dielectric_row();
ModelRow dielectric_row();
ModelRow oren_nayar_row();
ModelRow rpv_row();
ModelRow ross_li_row();
ModelRow roujean_row();
ModelRow priest_germer_row();
ModelRow beard_maxwell_row();
ModelRow shell_row();
ModelRow leaf_row();
ModelRow sqt_row();
ModelRow sea_row();
ModelRow coated_row();

}  // namespace suite
