// Scenes of DIRSIG: translated into a scene text, and read as one.
#pragma once
#include "scene/importer.h"

namespace suite {

ImporterRow dirsig_importer();

}  // namespace suite
