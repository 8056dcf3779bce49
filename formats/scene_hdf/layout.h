// Names and numbers that reader and writer share.
#pragma once

namespace suite::h5 {

inline constexpr const char* kFormat = "suite.scene";
inline constexpr const char* kVersionText = "1";
inline constexpr int kConstantCurve = 255;  // in place of an Outside rule

}  // namespace suite::h5
