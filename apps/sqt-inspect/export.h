// A bundle in other people's formats.
#pragma once
#include <string>

#include "formats/sqt/sqt.h"
#include "options.h"

namespace suite {

// UsageError: an extension that is none of .csv, .raw, .bsdf, .xml; a size or error out of its range.
void check_export(const InspectOptions& options);

// Writes options.export_to as its extension says and tells how far the file is from the bundle: .csv and .raw hold its
// own values at their directions; .bsdf and .xml are tables of their own, made so fine that their l1 to the bundle is
// at most options.export_error (0: what the file states of the fit), compared with the bundle as they are read; what
// they are off by stands in them. A warning when the size does not allow it. What they leave out (a Dirac lobe) is told
// with its share. Error: the format cannot hold such a function.
void export_bundle(const InspectOptions& options, const SqtFile& file);

}  // namespace suite
