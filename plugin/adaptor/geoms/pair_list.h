// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "adaptor/keys/scene_keys.h"
#include "adaptor/mujoco/mjgeoms.h"

namespace volcontact::adaptor {

/// Why two geoms can touch.
enum class PairOrigin : int {
  kMasks = 0,     ///< contype and conaffinity
  kExplicit = 1,  ///< a <pair> of the model
  kListed = 2,    ///< a volcontact/pair/...
};
inline constexpr const char* kPairOriginWords[] = {"contype/conaffinity", "<pair>",
                                                   "volcontact/pair"};

/// Two geoms that can touch; `a` has the lower id.
struct GeomPair {
  int a;
  int b;
  PairOrigin origin;
  int listed = -1;  ///< index into SceneKeys::pairs, -1 when no volcontact/pair names the two
  int native = -1;  ///< number of a <pair> of the model that names the two, -1 where none does
};

/// The pairs that can touch, in ascending order of (a, b): MuJoCo's own rules (bit masks; not
/// within one rigid body; not parent and child; not excluded; explicit pairs whatever the masks
/// say) and the scene's listed pairs, or the latter alone.
/// `listed_only`: no others than those listed for volcontact.
std::vector<GeomPair> pairs_that_can_touch(const mjModel* m, const SceneKeys& keys,
                                           bool listed_only = false);

/// Leaves out, step by step, the pairs whose bounds are apart. Const once made.
class Cull {
 public:
  /// `solids` has one entry per geom of the model; those of no pair are not looked at. Refers to
  /// `pairs`, which are in ascending order.
  Cull(const std::vector<GeomPair>& pairs, const std::vector<Shape>& solids);

  /// Bounds along x, y and z, in both orders: two boxes are compared by adding one to the other's
  /// reverse.
  using Two [[gnu::vector_size(16)]] = double;
  struct Box {
    std::array<Two, 3> ends;     ///< min, -max
    std::array<Two, 3> reverse;  ///< -max, min
  };

  /// Memory of one call, reused. What it holds changes no result.
  struct Scratch {
    std::vector<Box> boxes;   ///< world bounds
    std::vector<int> sorted;  ///< solids by their lower ends, as they were sorted last
    std::vector<double> low, high;
    std::vector<int> near;  ///< result: indices of pairs, ascending
  };

  void run(const mjData* d, Scratch& scratch) const;

 private:
  struct Bounded {
    int geom;
    Shape solid;
  };
  struct WithPlane {
    int pair, plane;
    int other;  // index into bounded_
  };
  int pair_of(int a, int b) const;
  void find_all(Scratch& scratch) const;
  void sweep(Scratch& scratch) const;

  const std::vector<GeomPair>* pairs_;
  std::vector<int> row_;  // by geom: its first pair as `a`; one more at the end
  std::vector<Bounded> bounded_;
  std::vector<int> bounded_of_geom_;  // -1: a plane, or in no pair
  std::vector<WithPlane> with_plane_;
  bool is_swept_ = false;  // whether there are so many pairs that a sweep finds them sooner
};

}  // namespace volcontact::adaptor
