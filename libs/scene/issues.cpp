// One row a finding: code, severity, summary, hint. SP0 text, SP1 materials and curves, SP2 geometry files, SP3 mesh
// quality, SP4 assembly, SP5 maps, SP6 media, SP7 imports.
#include "scene/issues.h"

namespace suite {

namespace {
using enum Severity;
struct Row {
  const char* code;
  Severity severity;
  const char *summary, *hint;
};
constexpr Row kRows[] = {
    {"SP001", error, "the scene text is wrong", ""},
    {"SP002", error, "unknown key", "remove it or correct its name"},
    {"SP003", error, "a file cannot be read", ""},
    {"SP004", warning, "a key or an option is given by an old name", "write the new name that the text states"},
    {"SP101", error, "a material is described wrongly", ""},
    {"SP102", error, "unknown material", ""},
    {"SP103", warning, "a material is not used", "remove it, or check the names that should refer to it"},
    {"SP104", error, "a curve or a fitted file does not cover a declared spectral window",
     "give a longer one, or declare 'outside: hold' or 'zero'"},
    {"SP105", error, "a material reflects and transmits more than it receives",
     "reflectance + transmittance must not exceed 1"},
    {"SP106", error, "a temperature table does not cover the time that is looked at",
     "give a longer table, 'repeat: true', or a shorter 'times_s'"},
    {"SP107", warning, "a temperature is that of deep space", "temperatures are in kelvin"},
    {"SP108", info, "what a model of the sea's surface rests on", ""},
    {"SP109", warning, "a curve has marks of deleted channels", ""},
    {"SP110", warning, "all wavelengths of a curve are beyond 100 um, as if they were nanometres",
     "name the unit in the header of its file: wavelength_nm, or nm in a comment"},
    {"SP201", error, "a face names something that is not there",
     "indices count from 1, or from the end when negative; 0 is nothing"},
    {"SP202", warning, "a face has fewer than three corners and is left out", "give at least three corners"},
    {"SP203", error, "a coordinate is not a finite number", "give plain decimal numbers"},
    {"SP204", error, "there is no triangle", "the file must hold at least one face"},
    {"SP205", info, "lines, points, curves or free-form surfaces are left out", "only faces are geometry here"},
    {"SP206", warning, "a concave or non-planar polygon cannot be split cleanly",
     "triangulate it in the modelling tool"},
    {"SP207", info, "not every corner has a normal",
     "corners without one are smoothed within their smoothing group ('s'), flat where they have none"},
    {"SP208", info, "not every corner has a texture coordinate", "corners without one get (0, 0)"},
    {"SP209", warning, "a face names a normal or texture coordinate that is not there",
     "the corner is taken as having none"},
    {"SP301", warning, "a triangle has two corners at one place", "--repair drops it"},
    {"SP302", warning, "a triangle has no area", "--repair drops it"},
    {"SP303", info, "a triangle is a sliver", "its normal is uncertain; remesh if it matters"},
    {"SP304", warning, "a triangle repeats another one", "--repair drops it"},
    {"SP305", warning, "more than two triangles share an edge", "split the surface there"},
    {"SP306", info, "the surface is open", "close it where it should hold a medium"},
    {"SP307", warning, "neighbouring triangles are wound differently", "--repair turns them"},
    {"SP308", warning, "triangles cross each other", "light may leak; mend it in the modelling tool"},
    {"SP309", info, "positions belong to no face", "they are left out"},
    {"SP310", info, "the mesh has several pieces", ""},
    {"SP311", warning, "a vertex normal points to the other side of its triangle",
     "use 'normals: facet' or 'smooth', or turn the face"},
    {"SP312", info, "surfaces touch in a single vertex", ""},
    {"SP313", warning, "the extent is absurd", "check 'unit_m'"},
    {"SP314", warning, "two triangles lie back to back", "which one is hit is arbitrary; use one two-sided face"},
    {"SP315", warning, "too many triangles overlap to look for crossings",
     "the mesh is badly tangled; mend it in the modelling tool, or use --no-crossing-check"},
    {"SP320", info, "repaired", ""},
    {"SP321", info, "holes are closed", ""},
    {"SP322", info, "decimated", ""},
    {"SP323", warning, "not decimated as far as asked for",
     "what is left is held by the error allowed, by open edges, and by borders of materials, groups, texture "
     "coordinates and normals"},
    {"SP401", error, "a placement names something that is not there", ""},
    {"SP402", error, "groups contain each other", "a group may only contain groups that do not lead back to it"},
    {"SP403", warning, "an object is never placed", "remove it, or place it in 'world' or in a group that is"},
    {"SP404", error, "a transform flattens, is not finite or leads absurdly far away",
     "scales must not be 0, places are within 1e13 m"},
    {"SP405", error, "a place is not on the terrain", "x and y must lie inside the terrain, outside of its gaps"},
    {"SP406", error, "nothing is placed", "'world' must place something"},
    {"SP601", error, "a medium or a voxel grid is described wrongly", ""},
    {"SP602", error, "unknown medium or voxel grid", ""},
    {"SP603", warning, "a medium or a voxel grid is not used", "remove it, or check the names that should refer to it"},
    {"SP604", error, "a voxel has an impossible density or temperature",
     "densities are at least 0, temperatures 0 to 1e5 K"},
    {"SP605", error, "extinction is not absorption + scattering", "give two of the three"},
    {"SP606", warning, "a surface that bounds a medium is open",
     "paths that enter it may never leave; close it, unless it is a surface without end such as a sea's"},
    {"SP607", warning, "a scattering medium has no end",
     "paths in it take that much longer, up to the simulation's 'max_scatterings'; a layer is one object, 'box: {z0, "
     "z1}' "
     "without x and y"},
    {"SP608", info, "what a medium of water leaves out or rests on", ""},
    {"SP609", info, "what a surface of waves leaves out", "a finer 'step_m', or a rough model"},
    {"SP610", warning, "bodies of media of equal priority share a face",
     "give the media priorities, or move one of the faces a little"},
    {"SP407", error, "a motion does not cover the time that is looked at", "give it more keys, or a shorter 'times_s'"},
    {"SP408", warning, "an exact surface, a volume or a moving group is too large to follow the curvature",
     "use a mesh, or several smaller ones"},
    {"SP409", warning, "edges are too long to follow the curvature", "cut the mesh into smaller triangles"},
    {"SP410", info, "motions are not laid onto the curved Earth",
     "their positions count in the scene's tangent frame; geodetic, UTM and ECEF places are right anywhere"},
    {"SP411", error, "copies are too many",
     "all groups together unfold into at most 2^32 - 2 instances; placements that are kept once are at most 2^28"},
    {"SP412", error, "a lifetime ends before it begins, or a schedule is described wrongly",
     "'appears' before 'disappears'; rows of a schedule in the order of their times"},
    {"SP413", error, "traffic of a type that nothing stands for",
     "give each type an object under 'types', or a 'default'"},
    {"SP501", error, "a map is described wrongly", ""},
    {"SP502", error, "a map holds a class that has no material", "list a material for it"},
    {"SP503", warning, "a map is not used", "name it by 'map:' in a material"},
    {"SP504", error, "a terrain cannot be put in place", ""},
    {"SP505", warning, "the scene's origin is far from its terrain", "correct 'origin'"},
    {"SP506", warning, "a terrain may hold marks of missing heights", "say 'no_data: MARK', or --mute SP506"},
    {"SP507", info, "what a raster's file says of its numbers", ""},
    {"SP508", warning, "a terrain's file has a vertical pixel scale", "say 'height_scale' where the heights count it"},
    {"SP509", warning, "heights that count from the geoid are taken as above the ellipsoid",
     "say 'height: geoid', and give the geoid: 'geoid_separation_m', or a grid in 'origin'"},
    {"SP701", warning, "an imported file says what is lost here",
     "--import-report FILE.json lists every line of the import"},
    {"SP702", info, "an imported file says what has no effect here", ""},
    {"SP703", info, "an imported file says what is approximated here",
     "--import-report FILE.json lists every line of the import"},
    {"SP704", error, "a strict import leaves out what an imported file says",
     "leave out --strict, or take it out of the file"},
    {"SP705", warning, "a model's file says what is lost here", ""},
    {"SP706", info, "a model's file says what has no effect here", ""},
    {"SP707", info, "a model's file says what is approximated here", ""},
    {"SP708", warning, "a model's material has no spectrum and is a stand-in",
     "give it one: --set 'materials.NAME={model: lambert, reflectance: CURVE}', or name it in a scene text"},
    {"SP709", warning, "a model's file contradicts itself", ""},
};
}  // namespace

std::vector<IssueKind> scene_issues() {
  std::vector<IssueKind> kinds;
  for (const Row& row : kRows) kinds.push_back({row.code, row.severity, row.summary, row.hint});
  return kinds;
}

}  // namespace suite
