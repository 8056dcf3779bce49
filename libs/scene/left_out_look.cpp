#include "scene/left_out_look.h"

namespace suite {

std::string LeftOutLook::text() const {
  std::string list;
  const auto add = [&](size_t count, const char* what, const char* of, const char* instead) {
    if (!count) return;
    list += strf("%s%s of %zu %s%s (%s)", list.empty() ? "" : ", ", what, count, of, count == 1 ? "" : "s", instead);
  };
  add(see_through, "transparency", "material", "an 'opacity' map makes holes");
  add(shining, "emission", "material", "temperatures and lamps shine");
  add(bumps, "normal or bump maps", "material", "'bump' and 'normal' maps of the scene text are heights and normals");
  add(gloss, "gloss, metal or occlusion", "material", "'materials' names models that have it");
  add(coloured, "colours of vertices", "mesh part", "display colours are no spectra");
  add(one_sided, "one-sidedness", "material", "surfaces are seen from behind, too");
  return list.empty() ? list : "left out of how surfaces look: " + list;
}

void LeftOutLook::report(const std::string& file, Report& to) const {
  if (count() == 0) return;
  to.add(count() > one_sided ? "SP705" : "SP706", file, {Where{file, 0, 0, {}, -1}, text()}, count());
}

}  // namespace suite
