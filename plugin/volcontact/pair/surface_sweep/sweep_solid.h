// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "volcontact/pair/convex/face_set.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// A face of a member of a solid, in the frame W of the window.
struct SweepFace {
  enum class Kind : int { kPlane = 0, kBall, kTube, kCone, kTorus };
  Kind kind = Kind::kPlane;
  Owner owner = Owner::kA;
  bool seam = false;                ///< between two parts of one member: no surface
  int twin = 0;                     ///< the first face in the same surface, perhaps itself
  int side = 1;                     ///< 1 when the twin looks the same way, else -1
  int smooth = 0;                   ///< the same of faces that go on in each other without an edge
  Vec3 normal = Vec3::UnitZ();      ///< of a plane; the axis of a torus
  double offset = 0.0;              ///< of a plane
  RoundFace round{};                ///< of a ball (an ellipsoid as well), tube or cone
  double major = 0.0, minor = 0.0;  ///< of a torus about round.center

  /// Negative inside of the face; of any unit.
  double value(const Vec3& x) const;
};

/// An intersection of faces.
struct SweepPart {
  int first = 0, last = 0;  ///< of its faces
  Owner owner = Owner::kA;
};

/// Two solids as formulas over convex parts (and tori), in the frame W, with all that is the same
/// throughout a box about the origin taken out.
class SweepSolids {
 public:
  static constexpr int kMostParts = 64;

  std::vector<SweepFace> faces;
  std::vector<SweepPart> parts;  ///< A's, then B's; only those with a face in the box
  Vec3 half;                     ///< of the box

  /// Reads two solids; false for meshes, signed distances, and more than kMostParts.
  bool read(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, const Vec3& half);

  /// Whether a solid holds a place that is in these parts.
  bool holds(Owner owner, std::uint64_t in_parts) const {
    const Table& table = tables_[index(owner)];
    if (!table.filled) return evaluate(owner, in_parts);
    return (table.answers >> ((in_parts >> table.first) & table.mask) & 1u) != 0;
  }

 private:
  enum class Join : int { kLeaf, kUnion, kIntersection, kDifference };
  struct Step {
    Join join;
    std::uint64_t mask;   ///< of a leaf: a member is the union of these parts
    bool always = false;  ///< of a leaf: holds all of the box
  };
  /// The formula of a solid of few parts, worked out for every set of them.
  struct Table {
    bool filled = false;
    int first = 0;  ///< of its parts
    std::uint64_t mask = 0, answers = 0;
  };

  bool read_solid(const Shape& shape, const Pose& X_WS, Owner owner);
  bool read_member(const SimpleShape& shape, const Pose& X_WM, Owner owner);
  class PartWriter;
  template <typename S>
  void add_parts(const S& solid, const Pose& X_WM, Owner owner);
  void end_part(int first, Owner owner);
  void prune();
  void drop_parts(std::uint64_t dropped, std::uint64_t within);
  void fill_table(Owner owner);
  bool evaluate(Owner owner, std::uint64_t in_parts) const;
  void find_twins();
  bool same_surface(const SweepFace& one, const SweepFace& other, int& side) const;

  std::vector<Step> steps_[2];
  Table tables_[2];
  FaceSet set_;
};

}  // namespace volcontact
