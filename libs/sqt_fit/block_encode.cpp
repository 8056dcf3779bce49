// The symbols of the aligned method, written; see sqt/block_code.h.
#include "sqt/block_code_coders.h"
#include "sqt_fit/prefix_encoder.h"

namespace suite::sqt {

using namespace block_code;

inline LevelSymbol code_level(PrefixEncoder& coder, int32_t& level, size_t context) {
  const Token t = token_of(static_cast<uint32_t>(std::abs(level)), kExactLevel);
  coder.symbol(context, t.symbol);
  if (t.symbol) coder.raw(level < 0, 1);
  if (t.bits) coder.raw(t.raw, t.bits);
  return {t.symbol, size_class(t.symbol)};
}

template int32_t BlockCode::code(PrefixEncoder&, std::span<int32_t>, size_t, int32_t);
template uint32_t BlockCode::code_split(PrefixEncoder&, uint32_t, int32_t, int);

}  // namespace suite::sqt
