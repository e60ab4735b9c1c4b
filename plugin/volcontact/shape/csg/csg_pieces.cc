// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_pieces.h"

#include <algorithm>
#include <optional>

#include "volcontact/base/interrupt.h"
#include "volcontact/shape/csg/csg_faces.h"

namespace volcontact {
namespace {

using Operation = Csg::Operation;

constexpr std::size_t kMostParts = 400;

// One side of a face. `surface`: crossing it leaves the solid, otherwise it is a seam.
struct Literal {
  MemberFace face;
  bool inside = true;
  bool surface = true;
};

// A part of space: all literals hold.
struct Part {
  std::vector<Literal> literals;
  PartHull hull;
};
using Parts = std::vector<Part>;

// How a part of one solid meets the faces of another one, for whether they become surface.
enum class Join {
  kBothNeeded,  ///< of an intersection or difference: leaving either leaves the result
  kEitherDoes,  ///< part of a union outside of the other operand: its faces lead into that one
  kBothHeld,    ///< part of a union inside of both operands
};

bool surface_where_both(Join join, bool own, bool other) {
  if (join == Join::kBothNeeded) return own || other;
  return join == Join::kEitherDoes ? own && !other : own && other;
}

struct NotInPieces {};

class Decomposition {
 public:
  explicit Decomposition(const Csg& solid) : solid_(solid), size_(size_of(solid)) {
    std::vector<int> waiting;
    for (const Csg::Step& step : solid.steps()) {
      Node node{step, -1, -1};
      if (step.member < 0) {
        node.right = waiting.back(), waiting.pop_back();
        node.left = waiting.back(), waiting.pop_back();
      }
      waiting.push_back(static_cast<int>(nodes_.size()));
      nodes_.push_back(node);
    }
  }

  Parts all() { return parts_of(static_cast<int>(nodes_.size()) - 1); }

 private:
  struct Node {
    Csg::Step step;
    int left, right;
  };
  // A face a part is cut by, on its way to become a literal.
  struct Cut {
    MemberFace face;
    bool inside;
    bool leads_out;  // across it lies what is cut off, as far as this face goes
  };

  Parts parts_of(int index);
  Parts parts_of_member(const Csg::Member& member) const;
  Parts meet(const Parts& a, const Parts& b, Join join) const;
  Parts without(const Parts& parts, int index, Join join);
  void without_member(const Part& part, const Csg::Member& member, Join join, Parts& out) const;
  void without_convex(const Part& part, const std::vector<Literal>& literals, Join join,
                      Parts& out) const;
  void branch(const Part& original, const PartHull& hull, const std::vector<Literal>& literals,
              std::size_t next, std::vector<Cut>& cuts, int violated, Join join, Parts& out) const;
  std::optional<Part> joined(const Part& part, const PartHull& hull, const std::vector<Cut>& cuts,
                             bool one_leads_out, Join join) const;
  bool constrain(const std::vector<Literal>& literals, const std::vector<Cut>& cuts,
                 const MemberFace& face, bool inside, PartHull& hull) const;
  bool contradicts(const MemberFace& a, bool a_inside, const MemberFace& b, bool b_inside) const;
  bool same_side(const MemberFace& a, bool a_inside, const MemberFace& b, bool b_inside) const;
  bool always(const PartHull& hull, const MemberFace& face, bool inside, double slack) const;
  static void check(const Parts& parts) {
    if (parts.size() > kMostParts) throw NotInPieces{};
  }

  const Csg& solid_;
  const double size_;
  std::vector<Node> nodes_;
};

// ---- faces and hulls

// Whether all of the hull is on that side, up to `slack` tolerances beyond.
bool Decomposition::always(const PartHull& hull, const MemberFace& face, bool inside,
                           double slack) const {
  const double allowed = slack * face.tolerance(size_);
  return inside ? hull.most(face) <= allowed : hull.stays_above(face, -allowed);
}

bool Decomposition::same_side(const MemberFace& a, bool a_inside, const MemberFace& b,
                              bool b_inside) const {
  if (a.kind != MemberFace::Kind::kPlane) return a_inside == b_inside && a.same_as(b, size_);
  if (b.kind != MemberFace::Kind::kPlane) return false;
  MemberFace one, two;
  one.quadric = a.oriented(a_inside);
  two.quadric = b.oriented(b_inside);
  return one.same_as(two, size_);
}

bool Decomposition::contradicts(const MemberFace& a, bool a_inside, const MemberFace& b,
                                bool b_inside) const {
  if (a.kind != MemberFace::Kind::kPlane || b.kind != MemberFace::Kind::kPlane) {
    return same_side(a, a_inside, b, !b_inside);
  }
  const Quadric one = a.oriented(a_inside), two = b.oriented(b_inside);
  return (one.linear + two.linear).norm() <= kSameFace &&
         one.constant + two.constant >= -kSameFace * size_;
}

// Adds a face to a part: cuts the hull. False when nothing is left.
bool Decomposition::constrain(const std::vector<Literal>& literals, const std::vector<Cut>& cuts,
                              const MemberFace& face, bool inside, PartHull& hull) const {
  for (const Literal& literal : literals) {
    if (contradicts(literal.face, literal.inside, face, inside)) return false;
  }
  for (const Cut& cut : cuts) {
    if (contradicts(cut.face, cut.inside, face, inside)) return false;
  }
  if (always(hull, face, !inside, 1.0)) return false;
  if (face.kind == MemberFace::Kind::kPlane) {
    hull.cut(face, inside);
  } else if (inside) {
    hull.cut_round(face);
  }
  return !hull.empty();
}

// Whether the plane is across the axis of a cone that the part is inside of. Such planes keep it
// from the other nappe, and off the space where the cone grows wider than the hull around it.
bool ends_a_cone(const Literal& plane, const std::vector<Literal>& literals) {
  if (plane.face.kind != MemberFace::Kind::kPlane) return false;
  return std::any_of(literals.begin(), literals.end(), [&](const Literal& other) {
    if (other.face.kind != MemberFace::Kind::kCone || !other.inside) return false;
    const Vec3 axis = other.face.X_FS.rotation.row(2);
    return plane.face.quadric.linear.cross(axis).norm() <= kSameFace;
  });
}

// The part with the faces it was cut by. Faces that do not reach it are left out.
std::optional<Part> Decomposition::joined(const Part& part, const PartHull& hull,
                                          const std::vector<Cut>& cuts, bool one_leads_out,
                                          Join join) const {
  Part result{part.literals, hull};
  for (Literal& literal : result.literals) {
    if (join == Join::kBothHeld) literal.surface = false;
  }
  for (const Cut& cut : cuts) {
    const bool leads_out = cut.leads_out && one_leads_out;
    bool known = false;
    for (std::size_t i = 0; i < part.literals.size(); ++i) {
      const Literal& own = part.literals[i];
      if (!same_side(own.face, own.inside, cut.face, cut.inside)) continue;
      result.literals[i].surface = surface_where_both(join, own.surface, leads_out);
      known = true;
    }
    if (!known) {
      result.literals.push_back({cut.face, cut.inside, join == Join::kBothNeeded && leads_out});
    }
  }
  std::vector<Literal> all;
  all.swap(result.literals);
  for (const Literal& literal : all) {
    if (ends_a_cone(literal, all) || !always(hull, literal.face, literal.inside, -1.0)) {
      result.literals.push_back(literal);
    }
  }
  return result;
}

// ---- parts of a solid

Parts Decomposition::parts_of_member(const Csg::Member& member) const {
  Parts parts;
  for (const auto& faces : member_faces(member.shape, member.X_SM)) {
    Part part{{}, PartHull(member.shape, member.X_SM)};
    for (const MemberFace& face : faces) {
      if (face.kind == MemberFace::Kind::kPlane) part.hull.cut(face, true);
      part.literals.push_back({face, true, !face.seam});
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

Parts Decomposition::parts_of(int index) {
  const Node node = nodes_[index];
  if (node.step.member >= 0) return parts_of_member(solid_.members()[node.step.member]);
  const Parts a = parts_of(node.left);
  if (node.step.operation == Operation::kDifference) {
    return without(a, node.right, Join::kBothNeeded);
  }
  const Parts b = parts_of(node.right);
  if (node.step.operation == Operation::kIntersection) return meet(a, b, Join::kBothNeeded);
  Parts all = without(a, node.right, Join::kEitherDoes);
  for (Part& part : without(b, node.left, Join::kEitherDoes)) all.push_back(std::move(part));
  for (Part& part : meet(a, b, Join::kBothHeld)) all.push_back(std::move(part));
  check(all);
  return all;
}

Parts Decomposition::meet(const Parts& a, const Parts& b, Join join) const {
  Parts out;
  for (const Part& one : a) {
    for (const Part& two : b) {
      // From the bounded one.
      const bool swap = !one.hull.bounded() && two.hull.bounded();
      const Part& part = swap ? two : one;
      const Part& other = swap ? one : two;
      PartHull hull = part.hull;
      std::vector<Cut> cuts;
      bool left = true;
      for (const Literal& literal : other.literals) {
        left = left && constrain(part.literals, cuts, literal.face, literal.inside, hull);
        if (!left) break;
        cuts.push_back({literal.face, literal.inside, literal.surface});
      }
      if (!left) continue;
      if (auto both = joined(part, hull, cuts, true, join)) out.push_back(std::move(*both));
      check(out);
    }
  }
  return out;
}

// What of the parts is outside of the solid of a node.
Parts Decomposition::without(const Parts& parts, int index, Join join) {
  const Node node = nodes_[index];
  Parts out;
  if (node.step.member >= 0) {
    for (const Part& part : parts) {
      InterruptScope::poll();
      without_member(part, solid_.members()[node.step.member], join, out);
      check(out);
    }
    return out;
  }
  if (node.step.operation == Operation::kUnion) {
    return without(without(parts, node.left, join), node.right, join);
  }
  Parts left = parts;
  for (const Part& cutter : parts_of(index)) {
    out.clear();
    for (const Part& part : left) without_convex(part, cutter.literals, join, out);
    check(out);
    left.swap(out);
  }
  return left;
}

void Decomposition::without_member(const Part& part, const Csg::Member& member, Join join,
                                   Parts& out) const {
  const auto convex_parts = member_faces(member.shape, member.X_SM);
  if (convex_parts.size() <= 1) {
    std::vector<Literal> literals;
    if (convex_parts.size() == 1) {
      for (const MemberFace& face : convex_parts[0]) literals.push_back({face, true, true});
    }
    if (literals.empty()) return out.push_back(part);
    return without_convex(part, literals, join, out);
  }
  // The planes between the parts divide all space: in each share one round face does the cutting.
  for (const auto& faces : convex_parts) {
    PartHull hull = part.hull;
    std::vector<Cut> cuts;
    bool left = true;
    for (const MemberFace& face : faces) {
      const bool inside = face.kind == MemberFace::Kind::kPlane;
      left = left && constrain(part.literals, cuts, face, inside, hull);
      if (!left) break;
      if (!always(hull, face, inside, -1.0)) cuts.push_back({face, inside, !inside});
    }
    if (!left) continue;
    if (auto rest = joined(part, hull, cuts, true, join)) out.push_back(std::move(*rest));
  }
}

// The part without what lies within all the literals: cells in which at least one is violated. Only
// where exactly one is, that face is surface of what was cut off.
void Decomposition::without_convex(const Part& part, const std::vector<Literal>& literals,
                                   Join join, Parts& out) const {
  const double touching = join == Join::kBothNeeded ? 1.0 : -1.0;
  for (const Literal& literal : literals) {
    if (always(part.hull, literal.face, !literal.inside, touching)) return out.push_back(part);
    if (join != Join::kBothNeeded) continue;
    for (const Literal& own : part.literals) {
      if (contradicts(own.face, own.inside, literal.face, literal.inside)) {
        return out.push_back(part);
      }
    }
  }
  std::vector<Cut> cuts;
  branch(part, part.hull, literals, 0, cuts, 0, join, out);
}

// A tube around the edge where a cone ends in a plane, to go on beyond that plane, where the cone
// would come to its apex; radius 0: none.
MemberFace tube_beyond(const MemberFace& cone, const MemberFace& plane) {
  const Pose X_SF = cone.X_FS.inverse();
  const Vec3 axis = X_SF.rotation.col(2);
  if (plane.kind != MemberFace::Kind::kPlane ||
      plane.quadric.linear.cross(axis).norm() > kSameFace) {
    throw NotInPieces{};
  }
  const double z = (-plane.quadric.constant - plane.quadric.linear.dot(X_SF.translation)) /
                   plane.quadric.linear.dot(axis);
  const double radius = std::max(0.0, cone.radius + cone.slope * z);
  MemberFace tube;
  if (radius > 0.0) {
    tube = member_faces(Cylinder({.radius = radius, .half_length = 1.0}), X_SF)[0].back();
  }
  tube.radius = radius;
  return tube;
}

void Decomposition::branch(const Part& original, const PartHull& hull,
                           const std::vector<Literal>& literals, std::size_t next,
                           std::vector<Cut>& cuts, int violated, Join join, Parts& out) const {
  check(out);
  if (next == literals.size()) {
    if (violated == 0) return;  // what is cut off
    if (auto rest = joined(original, hull, cuts, violated == 1, join)) {
      out.push_back(std::move(*rest));
    }
    return;
  }
  MemberFace face = literals[next].face;
  const bool inside = literals[next].inside;
  if (face.kind == MemberFace::Kind::kCone && violated > 0) {
    const auto end =
        std::find_if(cuts.begin(), cuts.end(), [](const Cut& c) { return c.leads_out; });
    if (end == cuts.end()) throw NotInPieces{};
    face = tube_beyond(face, end->face);
    if (!(face.radius > kSameFace * size_)) {
      return branch(original, hull, literals, next + 1, cuts, violated + 1, join, out);
    }
  }
  for (const bool holds : {true, false}) {
    const bool side = holds == inside;
    PartHull rest = hull;
    if (!constrain(original.literals, cuts, face, side, rest)) continue;
    const bool reaches = !always(hull, face, side, -1.0);
    if (reaches) cuts.push_back({face, side, !holds});
    branch(original, rest, literals, next + 1, cuts, violated + !holds, join, out);
    if (reaches) cuts.pop_back();
  }
}

}  // namespace

PieceList csg_pieces(const Csg& solid) {
  PieceList list;
  for (const Csg::Member& member : solid.members()) {
    if (!has_pieces(member.shape)) return list;
  }
  try {
    for (const Part& part : Decomposition(solid).all()) {
      for (const Literal& literal : part.literals) {
        Quadric face = literal.face.oriented(literal.inside);
        face.seam = !literal.surface;
        list.add(face);
      }
      list.end_piece();
    }
  } catch (const NotInPieces&) {
    list.clear();
  }
  return list;
}

}  // namespace volcontact
