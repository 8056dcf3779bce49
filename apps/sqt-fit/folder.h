// A folder of measured files, fitted one after the other into a table like the paper's Figure 8.
#pragma once
#include "options.h"

namespace suite {

// Fits every measured file under options.input (folders inside too, in the order of their names) and writes, after each
// of them, the table options.output and a page beside it (.html). A row of an earlier table is kept where the file's
// content and all settings are the same. A file that cannot be fitted becomes a row with its fault. Returns 0, or 1
// when there was such a file. Error: no measured file there; the table's name is taken by something else.
// Based on: Goodenough & Brown, section V-A and Figure 8 (rmse in 1/sr over uniform directions is its metric).
int fit_folder(const SqtFitOptions& options);

}  // namespace suite
