// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace volcontact {

/// How an overlap is integrated. docs/theory.md, "Engines".
enum class Engine : int {
  kAuto = 0,          ///< the fastest that serves the pair to its tolerance
  kClosedForm = 1,    ///< formulas: half-space with every round shape, sphere-sphere
  kClip = 2,          ///< exact clipping of half-space, box and convex polytope
  kLines = 3,         ///< quadrature of exact columns: convex solids of plane and round faces
  kSurfaceSweep = 6,  ///< flux through the surface of the overlap: composed solids, tori
  kColumns = 5,       ///< signed columns from the triangles of meshes
  kOctree = 4,        ///< recursive cells with certified bounds; serves every pair
};

inline constexpr Engine kEngines[] = {Engine::kAuto,  Engine::kClosedForm,   Engine::kClip,
                                      Engine::kLines, Engine::kSurfaceSweep, Engine::kColumns,
                                      Engine::kOctree};

const char* to_string(Engine engine);

/// Throws std::invalid_argument naming the valid words and the nearest of them.
Engine engine_from(std::string_view name);

}  // namespace volcontact
