// Models of modelling tools by themselves: put into a scene text that says nothing else, and read as one.
#pragma once
#include "scene/importer.h"

namespace suite {

ImporterRow model_importer();

}  // namespace suite
