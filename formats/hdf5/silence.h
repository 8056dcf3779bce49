// Before the first call of the library, whoever makes it.
#pragma once

namespace suite::h5 {

// The library prints its error stack unless told not to. When the program ends it writes what a file still lacks, and
// crashes where that is refused; whoever writes here closes his files, so there is nothing left to do then.
void silence();

}  // namespace suite::h5
