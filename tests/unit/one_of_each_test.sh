#!/usr/bin/env bash
# one_of_each_test.sh SOURCES
# The decisions of transport stand once: where paths end by chance, what contributions share, where lights are asked,
# which numbers are drawn, and where the tracer is called. Kinds of lights are named by their own files, by the table that
# collects their rows, and by the suns that a capture brings itself, by the sky of the air (sky_table, sky_through_water), which
# is drawn as a table is; the solar spectrum, which decks and tables for atmospheric correction are lit by, is no light but stands among them, as does the
# spectrum of clear skies; the balance of heat weighs with both. What is outside is asked for its light, and once before whether
# there is any; surfaces that shine, where paths meet them and where ways through smooth interfaces end. Prints the list.
set -u
cd "$1" || exit 2
failed=0
# name, number of places, pattern, files
places() {
  local name=$1 wanted=$2 pattern=$3; shift 3
  local found
  found=$(grep -rnE "$pattern" "$@" --include=*.h --include=*.cpp | grep -vE '^[^:]*:[0-9]+: *//')
  local n=0
  [ -n "$found" ] && n=$(wc -l <<<"$found")
  printf '%-32s %d of %d\n' "$name" "$n" "$wanted"
  sed 's/^/    /' <<<"$found"
  if [ "$n" -ne "$wanted" ]; then failed=1; echo "    ^ expected $wanted"; fi
}
places "roulette"            1 'std::clamp\(brightness / kCarries, kLeast, most\)' libs
places "roulette's number"   1 'dimensions::of_roulette\(' libs
places "shared density"      1 'other \* \(other / own\)' libs
# The others: vertices that end where they sample (techniques/side_vertex.h, techniques/equiangular.h), and photons that count nothing themselves.
places "questions to lights" 4 '(light|light->)(\.light)?->sample\(' libs/transport
places "lights met outside"  2 '(\.|->)met_outside\(' libs/transport
places "surfaces that shine" 2 '(\.|->)met_surface\(' libs/transport
# The second one: side flights, which end where they ask (techniques/side_vertex.h).
places "explicit light"      2 'Estimator::asked\(' libs/transport
places "continuations"       1 'throughputs\.scatter\(' libs/transport
places "cut at max_nodes"    1 'most == 0 \|\|' libs/transport
# Beside a stage's own rays: which media a place lies in, what lies in one place with an interface, and ways through
# interfaces, whose rays follow from each other; and rays of the truth `sky_view`, which no path takes.
places "calls of the tracer" 7 'tracer(\(\))?\.(nearest|occluded|all)\(' libs/transport
places "kinds of lights"     23 'light/kinds/|\b(Sun|Moon|Sky|ClearSky|Lamp)Spec\b' \
  libs/[a-km-z]* libs/light/*.h libs/light/*.cpp apps formats
# Negative control: a second place is noticed.
twice=$(mktemp -d)
mkdir "$twice/libs"
printf '  return std::clamp(brightness / kCarries, kLeast, 1.0);\n%.0s' 1 2 > "$twice/libs/twice.h"
(cd "$twice" && failed=0 && places "control" 1 'std::clamp\(brightness / kCarries, kLeast, 1\.0\)' libs > /dev/null && [ $failed -eq 1 ]) ||
  { echo "a second place is not noticed"; failed=1; }
rm -r "$twice"
exit $failed
