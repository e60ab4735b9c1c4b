// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/clip/clip_engine.h"
#include "volcontact/pair/closed_form/closed_form.h"
#include "volcontact/pair/closed_form/one_face.h"
#include "volcontact/pair/closed_form/two_faces.h"
#include "volcontact/pair/mesh_columns/in_round/round_columns_engine.h"
#include "volcontact/pair/mesh_columns/mesh_columns_engine.h"
#include "volcontact/pair/mesh_columns/radial/radial_engines.h"
#include "volcontact/pair/octree/octree_engine.h"
#include "volcontact/pair/sections/bore/composed_sections_engine.h"
#include "volcontact/pair/sections/convex_sections_engine.h"
#include "volcontact/pair/sections/torus/torus_engines.h"
#include "volcontact/pair/surface_sweep/surface_sweep_engine.h"
#include "volcontact/pair/torus_pair/torus_pair_engine.h"

namespace volcontact {

/// Every engine there is, in the order in which they are asked. A new one is added here and nowhere
/// else.
using Engines = TypeList<ClosedForm, OneFace, TwoFaces, Clip, MeshAndComposed, ConvexSections,
                         ComposedSections, TorusAndConvex, TorusAndComposed, TorusPair,
                         SurfaceSweep, MeshAndMesh, MeshAndRound, MeshAndTorus, Octree>;

}  // namespace volcontact
