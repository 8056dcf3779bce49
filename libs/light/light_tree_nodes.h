// The nodes of a light tree. Internal to light_tree*.cpp.
#pragma once
#include <cstdint>

#include "light/light_tree.h"

namespace suite {

inline constexpr uint32_t kWide = 8, kLamp = 1u << 31, kNoNode = ~0u;
inline constexpr size_t kSteps = 32;  // of a LightProfile
// By which bounds on cosines are widened: they are compared in single precision, and rounding must not hide a lamp.
inline constexpr float kSlack = 1e-3f;
inline constexpr double kNear = 2;  // radii of a branch: from closer it may be opened
// Levels of the binary tree: by cost down to kCostly, halves below, of 2^32 lamps at most.
inline constexpr int kCostly = 32, kDeepest = kCostly + 32;

// Bounds of up to eight branches. Those that are not there have no power.
struct LightBranches {
  alignas(32) float x[kWide] = {}, y[kWide] = {}, z[kWide] = {}, radius[kWide] = {};  // spheres, from the tree's origin
  alignas(32) float power[kWide] = {};
  alignas(32) float inside[kWide] = {};  // what a branch is worth to places within its sphere
  alignas(32) float opens[kWide] = {};   // m2: opened from closer than the root of it; 0 for lamps
  // Of nodes that are not even:
  alignas(32) float axis_x[kWide] = {}, axis_y[kWide] = {}, axis_z[kWide] = {};
  alignas(32) float cos_cone[kWide] = {}, sin_cone[kWide] = {}, cos_spread[kWide] = {};
  alignas(32) int32_t both_sides[kWide] = {}, profile[kWide] = {};
  uint32_t child[kWide] = {};  // with kLamp set: a lamp, else the index of a node
  uint32_t parent = kNoNode;   // kWide x the node above + its branch that this is
  bool even = true;            // all branches send the same everywhere
  bool points = true;          // all of them are points
};

// Of the binary tree that the wide one is made of.
struct LightNode {
  LightBounds bounds;
  uint32_t lamps = 0;  // below it
  uint32_t next = 0;   // second child (the first follows), or the light of a leaf
};

}  // namespace suite
