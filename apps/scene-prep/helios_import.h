// Scenes of HELIOS++.
#pragma once
#include "scene/importer.h"

namespace suite {

ImporterRow helios_importer();

}  // namespace suite
