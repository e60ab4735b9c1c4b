// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "volcontact/shape/csg/bore.h"
#include "volcontact/shape/simple_shapes.h"

namespace volcontact {

/// A plane face of a CarvedPiece that other pieces of the solid lie against: surface in part only,
/// or not at all.
struct Seam {
  Vec3 normal;                                ///< outward from the piece, of unit length
  double offset = 0.0;                        ///< the face lies in normal . x = offset
  std::vector<std::vector<Quadric>> covered;  ///< by the neighbours: all F <= 0 in one of the lists

  /// Whether the point x of the face is surface of the solid.
  bool is_surface(const Vec3& x) const;
};

/// A convex body outside of round faces, in the frame S of the solid.
struct CarvedPiece {
  SimpleShape body;             ///< convex: no torus
  Pose X_SB;                    ///< of the body
  std::vector<Quadric> carved;  ///< F <= 0 is cut out of the body; may overlap each other
  std::vector<Seam> seams;
  /// The same as `carved`, in this order; none when one is no tube or cone, or when the body comes
  /// near the apex of a cone.
  std::vector<Bore> bores;
};

/// Union, intersection and difference of posed simple solids, nested as deep as wanted. Immutable;
/// copies share one data block. What takes time (pieces, own metrics) is worked out when first
/// asked for, or all of it by prepare(). docs/theory.md, "Composed solids".
class Csg {
 public:
  static constexpr const char* kName = "csg";
  enum class Operation { kUnion, kIntersection, kDifference };

  /// A solid of one member; `X_SM` is its pose.
  explicit Csg(const SimpleShape& member, const Pose& X_SM = {});
  /// a + b, a & b or a - b, in their common frame. Throws std::invalid_argument on more than
  /// kMostMembers members.
  Csg(Operation operation, const Csg& a, const Csg& b);
  /// The same solid elsewhere: X_WS is the pose of its present frame.
  Csg posed(const Pose& X_WS) const;

  static constexpr int kMostMembers = 256;

  struct Member {
    SimpleShape shape;
    Pose X_SM;
    Pose X_MS;
  };
  const std::vector<Member>& members() const;
  /// The tree in postfix order: a number is a member, the others join the last two operands.
  struct Step {
    int member = -1;
    Operation operation = Operation::kUnion;  ///< where `member` is -1
  };
  const std::vector<Step>& steps() const;

  Aabb bounds() const;
  /// A bound of it, where members are cut.
  double support_height(const Vec3& e) const;
  double signed_distance(const Vec3& p) const;
  Vec3 gradient(const Vec3& p) const;
  /// The volume is no larger: of the members, counted as if unions had nothing in common and
  /// nothing were cut off [m^3].
  double most_volume() const;
  /// Most parts of a straight line within the solid.
  int most_parts() const;
  /// Closed form where the carved pieces allow, else by lines to 1e-8, or approximate at a budget.
  VolumeMetrics own_metrics() const;

  /// Pieces with disjoint interiors whose faces are surface all over or not at all; none when a
  /// member has none (torus) or when there would be too many.
  void pieces(PieceList& list) const;

  /// The solid as pieces with disjoint interiors, each a convex body outside of round faces; empty
  /// when it cannot be written so.
  const std::vector<CarvedPiece>& carved_pieces() const;
  bool is_carved() const { return !carved_pieces().empty(); }

  /// Works out everything that is worked out once.
  void prepare() const;

 private:
  struct Data;
  explicit Csg(const std::shared_ptr<Data>& data);
  static std::shared_ptr<Data> one_member(const SimpleShape& member, const Pose& X_SM);
  static std::shared_ptr<Data> joined(Operation operation, const Csg& a, const Csg& b);

  std::shared_ptr<const Data> data_;
};

static_assert(Solid<Csg>);

}  // namespace volcontact
