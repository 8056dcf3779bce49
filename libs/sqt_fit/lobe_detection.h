// Which coordinates let the lobes of a function stand still as the view moves, and how finely its azimuths must be
// sampled when it has a preferred direction.
//
// A tree shared by all views is cheap to code and interpolates well when log f hardly changes from view to view at a
// fixed point of the divided sphere. That change is measured for every candidate frame (half vector, retro, direct)
// over the same pairs of directions, drawn near the mirror direction, near the viewer and everywhere, and weighted by
// the power that they carry. Where that is undecided, the candidates are coded coarsely, and what they need for one
// error decides.
//
// Rough surfaces, whose wide lobes are cut by the horizon and leave the mirror direction towards it, stand stillest in
// the direct frame: files of rough metals become two to three times smaller, of matte paper a third. Turning the half
// vector by the peak's own displacement at each view was tried on the same functions (GGX of roughness 0.3 and 0.45,
// Ward of 0.4, a measured flake paint): their files became 2 to 30 % larger, so that it was left out.
#pragma once
#include "sqt/function.h"
#include "sqt/lobe_map.h"

namespace suite::sqt {

// Mean |difference of log2 f| over steps of 5 deg of the view, up to 80 deg, at fixed points of the frame; weighted by
// f |cos|, all channels together; a difference counts at most 6. 0 where nothing is scattered. Surfaces only.
double change_with_view(const Function& function, LobeFrame frame);

// The frame in which a surface codes best; half vectors unless another gains markedly.
LobeFrame detect_frame(const Function& function);

// View azimuths, uniform over the circle, for which interpolation between them errs by about `allowed` (log2 units,
// mean weighted by f |cos|); an even number from 16 to 32.
size_t count_azimuths(const Function& function, LobeFrame frame, double allowed);

}  // namespace suite::sqt
