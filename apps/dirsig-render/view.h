// A page of finished results, to look at in a browser: pictures of any band, spectra of pixels, flags, truth.
#pragma once
#include <string>

#include "options.h"

namespace suite {

// Writes the HTML file `page`, which needs nothing else, of all images in a folder of results that have their errors
// and flags beside them. Radiance is kept as binary16, errors in a byte each; when that takes more than `bytes` of the
// file, every n-th column and row is kept alone, which a warning and the page tell. Error: no folder, no image in it,
// files that do not belong together or are damaged, page not writable.
void write_view(const std::string& folder, const std::string& page, size_t bytes);

// --view without a simulation: writes the page of what is in the folder of -o. False: that was not asked for.
// UsageError: options that do not go with --view; neither a simulation nor --view.
bool show_finished(const Cli& cli, const RenderOptions& o);
// --view after a run, of its own results. Returns 0.
int show_own(const RenderOptions& o);

}  // namespace suite
