// A bundle in other people's formats.
#pragma once
#include <string>

#include "options.h"
#include "sqt/bundle.h"

namespace suite {

// UsageError: an extension that is none of .csv, .raw, .bsdf, .xml; a size out of its range.
void check_export(const InspectOptions& options);

// Writes options.export_to as its extension says and tells how far the file is from the bundle: .csv and .raw hold its
// own values at their directions; .bsdf and .xml are tables of their own, compared with the bundle as they are read.
// What they leave out (a Dirac lobe) is told with its share. Error: the format cannot hold such a function.
void export_bundle(const InspectOptions& options, const sqt::Bundle& bundle);

}  // namespace suite
