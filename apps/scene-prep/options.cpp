#include "options.h"

namespace suite {

AppInfo scene_prep_info() {
  return {"scene-prep",
          "Reads a scene written as text with the models, rasters and curves it names, checks everything, and "
          "writes one HDF5 file "
          "that the renderer loads as it is.",
          "Examples:\n"
          "  scene-prep scene.yaml -o scene.h5 --report report.json\n"
          "  scene-prep house.glb -o house.h5 --set materials.roof.reflectance=0.3\n"
          "  scene-prep --summary scene.h5\n"
          "  scene-prep scene.h5 --quick-look tower.png --look-at tower --look-from '135 20'\n"
          "  scene-prep --gases recipe.yaml -o gases.h5\n"
          "  scene-prep --list-issues\n"
          "Exit codes: 0 written, 1 refused, 2 wrong usage, 3 a bug of ours. Grammar: formats/scene_text/FORMAT.md, "
          "of recipes formats/gas_recipe/FORMAT.md."};
}

namespace {

// What is asked of a prepared scene.
void declare_questions(Cli& cli, ScenePrepOptions& o) {
  cli.flag("--summary", o.summary, "print what a prepared scene holds");
  cli.option("--raycast", o.raycast,
             "print what a ray through a prepared scene meets: from x y z along dx dy dz, ENU, m", "'X Y Z DX DY DZ'");
  cli.option("--export-obj", o.export_obj, "write the placed meshes of a prepared scene, flattened, as OBJ",
             "FILE.obj");
  cli.option("--quick-look", o.quick_look, "write a picture of a prepared scene, from above, one colour a material",
             "FILE.png");
  cli.option("--look-at", o.look_at,
             "of the quick look: an object or tag by its name, an instance by its number, or a place, ENU, m",
             "NAME|'X Y [Z]'");
  cli.option("--look-size", o.look_size, "edge of what the quick look shows, m; a place needs one", "M");
  cli.option("--look-from", o.look_from,
             "where its viewer is: compass azimuth and elevation, degrees; without it above, north up", "'AZ EL'");
  cli.option("--pixels", o.pixels, "longer side of the quick look, 1 to 16384", "N");
}

void declare_view(Cli& cli, ScenePrepOptions& o) {
  cli.option("--view", o.view,
             "write a page with the scene in three dimensions, to turn and click on in a browser, which needs nothing "
             "else: of a prepared scene, or while one is prepared, with the findings of the check where they are",
             "FILE.html");
}

}  // namespace

void declare(Cli& cli, ScenePrepOptions& o) {
  cli.positional("input", o.input,
                 "scene text (YAML or JSON), a scene of DIRSIG (.scene, .cfg) or HELIOS++ (.xml), a model (.glb, "
                 ".gltf, .ply, .stl, "
                 ".fbx, .dae, .3ds), a city (CityJSON, CityGML), or a prepared scene with --summary",
                 false);
  cli.option("-o,--output", o.output, "prepared scene to write; without it the scene is only checked", "FILE.h5");
  cli.option("--path", o.search, "folder in which named files are also looked for (repeatable)", "DIR");
  cli.option(
      "--set", o.settings,
      "a value in place of the text's, such as materials.grey.reflectance=0.3; items of lists by number (from 0) or "
      "name, values in YAML, null takes a key out (repeatable)",
      "PATH=VALUE");
  cli.option("--report", o.report,
             "write the findings as JSON (- = standard output); what each step took is plotted beside it in FILE.html",
             "FILE.json");
  cli.option("--import-report", o.account,
             "of a scene of DIRSIG: write what became of every element and key of its files, with its line, as JSON",
             "FILE.json");
  cli.option("--convert", o.convert,
             "of a scene of DIRSIG or HELIOS++, a model or a city: write NAME.yaml, a scene text of ours, into this "
             "folder (of DIRSIG with "
             "the account), and stop",
             "FOLDER");
  cli.option("--mute", o.mute, "leave out findings of this code; muted errors do not refuse the scene (repeatable)",
             "CODE");
  cli.flag("--strict", o.strict,
           "warnings refuse the scene too; of a scene of DIRSIG whatever is left out, however harmless");
  cli.flag("--repair", o.repair,
           "weld positions, drop triangles without area and duplicates, make the winding consistent; each is reported");
  cli.option(
      "--compress", o.compress,
      "pack the prepared scene, which then loads more slowly: none (as without), deflate[:1-9] (6), or one of these "
      "for a dataset or group, e.g. /geometry/normals=deflate:9 (repeatable)",
      "[DATASET=]HOW");
  cli.flag("--uplift", o.uplift,
           "of a model: guess spectra from the display colours of its materials, in place of one grey for all");
  cli.flag("--no-crossing-check", o.quick, "do not look for triangles that cross each other");
  cli.flag("--force", o.force, "prepare again even when inputs, options and version are unchanged");
  cli.option("--gases", o.gases,
             "in place of a scene: bake the table of gas absorption of this recipe from line lists, for `atmosphere: "
             "{gases: FILE.h5}`; without -o only read it and what it names",
             "RECIPE.yaml");
  cli.flag("--list-issues", o.list_issues, "print every code that a check can bring up");
  cli.flag("--list-importers", o.list_importers, "print what scenes can be made from");
  cli.flag("--list-models", o.list_models, "print the scattering models and their parameters");
  cli.flag("--list-phases", o.list_phases, "print the phase functions and their parameters");
  cli.flag("--list-temperatures", o.list_temperatures, "print the temperature models and their parameters");
  cli.option("--explain", o.explain, "say when a part of a scene is loaded and when it is left out", "FEATURE");
  declare_questions(cli, o);
  declare_view(cli, o);
}

}  // namespace suite
