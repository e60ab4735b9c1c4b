// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg_carved.h"

#include <algorithm>
#include <optional>

namespace volcontact {
namespace {

using Operation = Csg::Operation;

constexpr std::size_t kMostPieces = 64;
constexpr double kRoundTube = 1e-9;  // how far a tube may be from round
constexpr double kNearApex = 0.02;   // least height over the apex of a cone, per the largest one
constexpr double kSameSlope = 1e-9;

using Carvings = std::vector<Carving>;

struct NotPossible {};

class Carver {
 public:
  explicit Carver(const Csg& solid) : solid_(solid), size_(size_of(solid)) {}

  Carvings all() {
    std::vector<Carvings> waiting;
    for (const Csg::Step& step : solid_.steps()) {
      if (step.member >= 0) {
        waiting.push_back(of_member(solid_.members()[step.member]));
        continue;
      }
      const Carvings b = std::move(waiting.back());
      waiting.pop_back();
      Carvings& a = waiting.back();
      if (step.operation == Operation::kUnion) a = united(a, b);
      if (step.operation == Operation::kIntersection) a = met(a, b);
      if (step.operation == Operation::kDifference) a = without(a, b);
      if (a.size() > kMostPieces) throw NotPossible{};
    }
    return waiting.back();
  }

 private:
  Carvings of_member(const Csg::Member& member) const;
  Carvings without(const Carvings& from, const Carvings& cutters, bool round_too = true) const;
  void cut_out(const Carving& piece, const std::vector<MemberFace>& cutter, Carvings& out) const;
  void carve(Carving piece, const MemberFace& round, Carvings& out) const;
  bool fills(const Carvings& a, const Carvings& b) const;
  Carvings united(const Carvings& a, const Carvings& b) const;
  Carvings met(const Carvings& a, const Carvings& b) const;
  std::optional<Carving> met(const Carving& piece, const Carving& other) const;
  Carving part(const Carving& of, PosedShape body) const;
  bool reach(const PartHull& hull, const std::vector<MemberFace>& faces) const;
  bool inside(const Carving& piece, const MemberFace& round) const;

  const Csg& solid_;
  const double size_;
};

std::vector<std::vector<MemberFace>> faces_of(const PosedShape& body) {
  return member_faces(body.shape, body.X_SM);
}

std::optional<Bore> as_tube(const Quadric& q) {
  const double h = 0.5 * q.hessian.trace();
  if (!(h > 0.0)) return std::nullopt;
  const Mat3 along = Mat3::Identity() - q.hessian / h;  // a a^T
  int largest;
  if (!(along.diagonal().maxCoeff(&largest) > 0.3)) return std::nullopt;
  Bore bore;
  bore.axis = along.col(largest).normalized();
  if (!((along - bore.axis * bore.axis.transpose()).norm() < kRoundTube)) return std::nullopt;
  bore.center = -(q.linear - bore.axis * bore.axis.dot(q.linear)) / h;
  const double square_radius = -2.0 * (q.constant + 0.5 * q.linear.dot(bore.center)) / h;
  if (!(square_radius > 0.0)) return std::nullopt;
  bore.radius = std::sqrt(square_radius);
  return bore;
}

std::optional<Bore> as_bore(const MemberFace& face) {
  if (face.kind == MemberFace::Kind::kRound) return as_tube(face.quadric);
  if (face.kind != MemberFace::Kind::kCone) return std::nullopt;
  const Pose X_SF = face.X_FS.inverse();
  Bore bore;
  bore.slope = std::abs(face.slope);
  bore.axis = X_SF.rotation.col(2) * (face.slope > 0.0 ? 1.0 : -1.0);
  bore.center = X_SF * Vec3(0.0, 0.0, -face.radius / face.slope);
  return bore;
}

// The plane across the axis that two tubes or cones share, where one begins to hold the other.
std::optional<MemberFace> crossing(const MemberFace& one, const MemberFace& other, double size) {
  const std::optional<Bore> a = as_bore(one), b = as_bore(other);
  if (!a || !b || a->axis.cross(b->axis).norm() > kSameFace ||
      a->from_axis(b->center).norm() > kSameFace * size) {
    return std::nullopt;
  }
  const double slope = a->axis.dot(b->axis) > 0.0 ? b->slope : -b->slope;
  if (!(std::abs(a->slope - slope) > kSameSlope)) return std::nullopt;
  const double height = (b->radius - slope * a->height(b->center) - a->radius) / (a->slope - slope);
  MemberFace plane;
  plane.quadric = Quadric::plane(a->axis, a->axis.dot(a->center) + height);
  return plane;
}

bool is_carved_by(const Carving& piece, const MemberFace& face) {
  return std::any_of(piece.carved.begin(), piece.carved.end(), [&](const MemberFace& round) {
    return round.quadric.constant == face.quadric.constant &&
           round.quadric.linear == face.quadric.linear &&
           round.quadric.hessian == face.quadric.hessian;
  });
}

Carvings Carver::of_member(const Csg::Member& member) const {
  if (std::holds_alternative<Torus>(member.shape)) throw NotPossible{};
  if (faces_of({member.shape, member.X_SM}).empty()) return {};  // of no volume
  return {Carving({member.shape, member.X_SM})};
}

// Whether the interior of a convex set with these faces may reach the hull.
bool Carver::reach(const PartHull& hull, const std::vector<MemberFace>& faces) const {
  PartHull rest = hull;
  for (const MemberFace& face : faces) {
    if (rest.least(face) >= -face.tolerance(size_)) return false;
    if (face.kind == MemberFace::Kind::kPlane) rest.cut(face, true);
    if (face.kind == MemberFace::Kind::kRound) rest.cut_round(face);
    if (rest.empty()) return false;
  }
  return true;
}

// Whether all of the piece's body lies within a round face.
bool Carver::inside(const Carving& piece, const MemberFace& round) const {
  if (piece.hull.most(round) <= round.tolerance(size_)) return true;
  for (const auto& faces : faces_of(piece.body)) {
    const bool within = std::any_of(faces.begin(), faces.end(), [&](const MemberFace& face) {
      return face.kind != MemberFace::Kind::kPlane && holds_within(face, round, piece.hull, size_);
    });
    if (!within) return false;
  }
  return true;
}

// A part of a piece: the carved faces that still reach it.
Carving Carver::part(const Carving& of, PosedShape body) const {
  Carving result(std::move(body));
  for (const MemberFace& round : of.carved) {
    if (result.hull.least(round) < -round.tolerance(size_)) result.carved.push_back(round);
  }
  return result;
}

void Carver::carve(Carving piece, const MemberFace& round, Carvings& out) const {
  if (inside(piece, round)) return;
  if (!(piece.hull.least(round) < -round.tolerance(size_))) return out.push_back(std::move(piece));
  for (const MemberFace& other : piece.carved) {
    const std::optional<MemberFace> plane = crossing(round, other, size_);
    if (!plane || !(piece.hull.most(*plane) > plane->tolerance(size_)) ||
        !(piece.hull.least(*plane) < -plane->tolerance(size_))) {
      continue;
    }
    Split halves = split(piece.body, *plane, size_);
    if (!halves.possible || !halves.inside || !halves.outside) continue;
    carve(part(piece, std::move(*halves.inside)), round, out);
    carve(part(piece, std::move(*halves.outside)), round, out);
    return;
  }
  const bool known = std::any_of(
      piece.carved.begin(), piece.carved.end(),
      [&](const MemberFace& other) { return holds_within(round, other, piece.hull, size_); });
  if (!known) {
    std::erase_if(piece.carved, [&](const MemberFace& other) {
      return holds_within(other, round, piece.hull, size_);
    });
    piece.carved.push_back(round);
  }
  out.push_back(std::move(piece));
}

// Cuts a convex set out of a piece: split at its planes, carved by its round face.
void Carver::cut_out(const Carving& piece, const std::vector<MemberFace>& cutter,
                     Carvings& out) const {
  if (!reach(piece.hull, cutter)) return out.push_back(piece);
  Carving rest = piece;
  for (const MemberFace& face : cutter) {
    if (face.kind != MemberFace::Kind::kPlane) return carve(std::move(rest), face, out);
    Split halves = split(rest.body, face, size_);
    if (!halves.possible) throw NotPossible{};
    if (halves.outside) out.push_back(part(rest, std::move(*halves.outside)));
    if (!halves.inside) return;
    rest = part(rest, std::move(*halves.inside));
  }
}

// The pieces outside of the cutters. With `round_too` false no piece may be left with a face
// carved by them.
Carvings Carver::without(const Carvings& from, const Carvings& cutters, bool round_too) const {
  Carvings left = from;
  for (const Carving& cutter : cutters) {
    Carvings next;
    for (const Carving& piece : left) {
      const auto convex_parts = faces_of(cutter.body);
      const bool meets = std::any_of(
          convex_parts.begin(), convex_parts.end(),
          [&](const std::vector<MemberFace>& faces) { return reach(piece.hull, faces); });
      if (!meets) {
        next.push_back(piece);
        continue;
      }
      if (!cutter.carved.empty()) throw NotPossible{};
      const std::size_t before = next.size();
      if (convex_parts.size() == 1) {
        cut_out(piece, convex_parts[0], next);
        for (std::size_t i = before; i < next.size() && !round_too; ++i) {
          if (is_carved_by(next[i], convex_parts[0].back())) throw NotPossible{};
        }
        continue;
      }
      if (!round_too) throw NotPossible{};
      // The planes between the parts divide all space: each share is cut by one round face.
      for (const auto& faces : convex_parts) {
        std::optional<Carving> share = piece;
        for (const MemberFace& face : faces) {
          if (face.kind != MemberFace::Kind::kPlane) {
            carve(std::move(*share), face, next);
            break;
          }
          Split halves = split(share->body, face, size_);
          if (!halves.possible) throw NotPossible{};
          if (!halves.inside) break;
          share = part(*share, std::move(*halves.inside));
        }
      }
    }
    left.swap(next);
    if (left.size() > kMostPieces) throw NotPossible{};
  }
  return left;
}

// Whether a round body of one fills a round face carved into the other: no surface on either side.
bool Carver::fills(const Carvings& a, const Carvings& b) const {
  for (const Carving& hole : b) {
    for (const Carving& piece : a) {
      for (const auto& faces : faces_of(piece.body)) {
        if (std::any_of(hole.carved.begin(), hole.carved.end(), [&](const MemberFace& round) {
              return round.same_as(faces.back(), size_);
            })) {
          return true;
        }
      }
    }
  }
  return false;
}

// The part of b outside of a beside a, or the other way round, whichever is simpler. What lies
// between them must be plane: only plane faces can be seams.
Carvings Carver::united(const Carvings& a, const Carvings& b) const {
  if (fills(a, b) || fills(b, a)) throw NotPossible{};
  std::optional<Carvings> best;
  for (const bool swap : {false, true}) {
    const Carvings &whole = swap ? b : a, &other = swap ? a : b;
    try {
      Carvings sum = without(other, whole, false);
      sum.insert(sum.begin(), whole.begin(), whole.end());
      if (best && sum.size() >= best->size()) continue;
      best = std::move(sum);
    } catch (const NotPossible&) {
    }
  }
  if (!best) throw NotPossible{};
  return *best;
}

// The part of a piece within the body of another one, carved by both.
std::optional<Carving> Carver::met(const Carving& piece, const Carving& other) const {
  const auto convex_parts = faces_of(other.body);
  const bool apart =
      std::none_of(convex_parts.begin(), convex_parts.end(),
                   [&](const std::vector<MemberFace>& faces) { return reach(piece.hull, faces); });
  if (apart) return std::nullopt;
  if (convex_parts.size() != 1) throw NotPossible{};
  Carving rest = piece;
  for (const MemberFace& face : convex_parts[0]) {
    if (face.kind != MemberFace::Kind::kPlane) {
      if (!inside(rest, face)) throw NotPossible{};
      continue;
    }
    Split halves = split(rest.body, face, size_);
    if (!halves.possible) throw NotPossible{};
    if (!halves.inside) return std::nullopt;
    rest = part(rest, std::move(*halves.inside));
  }
  Carvings one{std::move(rest)};
  for (const MemberFace& round : other.carved) {
    Carvings next;
    for (Carving& carving : one) carve(std::move(carving), round, next);
    one.swap(next);
  }
  return one.empty() ? std::nullopt : std::optional<Carving>(one[0]);
}

Carvings Carver::met(const Carvings& a, const Carvings& b) const {
  Carvings all;
  for (const Carving& one : a) {
    for (const Carving& two : b) {
      std::optional<Carving> both;
      try {
        both = met(one, two);
      } catch (const NotPossible&) {
        both = met(two, one);
      }
      if (both) all.push_back(std::move(*both));
    }
  }
  return all;
}

// ---- seams

// The region of a piece but for the face that lies in the plane.
std::vector<Quadric> region_beside(const CarvedPiece& piece, const std::vector<MemberFace>& faces,
                                   const MemberFace* plane) {
  std::vector<Quadric> region;
  for (const MemberFace& face : faces) {
    if (&face != plane) region.push_back(face.quadric);
  }
  for (const Quadric& round : piece.carved) region.push_back(round.reversed());
  return region;
}

void find_seams(std::vector<CarvedPiece>& pieces, double size) {
  std::vector<std::vector<MemberFace>> faces;
  for (const CarvedPiece& piece : pieces) {
    const auto parts = member_faces(piece.body, piece.X_SB);
    faces.push_back(parts.size() == 1 ? parts[0] : std::vector<MemberFace>());
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const MemberFace& face : faces[i]) {
      if (face.kind != MemberFace::Kind::kPlane) continue;
      Seam seam{face.quadric.linear, -face.quadric.constant, {}};
      MemberFace opposite;
      opposite.quadric = face.quadric.reversed();
      for (std::size_t j = 0; j < pieces.size(); ++j) {
        if (j == i) continue;
        for (const MemberFace& other : faces[j]) {
          if (other.kind != MemberFace::Kind::kPlane || !other.same_as(opposite, size)) continue;
          PartHull hull(pieces[i].body, pieces[i].X_SB);
          const bool meets =
              std::all_of(faces[j].begin(), faces[j].end(), [&](const MemberFace& f) {
                return &f == &other || hull.least(f) < -f.tolerance(size);
              });
          if (meets) seam.covered.push_back(region_beside(pieces[j], faces[j], &other));
        }
      }
      if (!seam.covered.empty()) pieces[i].seams.push_back(std::move(seam));
    }
  }
}

// ---- bores

// Whether a body keeps off the apex of a cone.
bool is_off_apex(const CarvedPiece& piece, const Bore& cone) {
  const auto height = [&](const Vec3& e) {
    const Vec3 e_B = piece.X_SB.rotation.transpose() * e;
    return e.dot(piece.X_SB.translation - cone.center) +
           std::visit([&](const auto& body) { return body.support_height(e_B); }, piece.body);
  };
  const double lowest = -height(-cone.axis), highest = height(cone.axis);
  return lowest > kNearApex * highest && highest < kInfinity;
}

std::vector<Bore> bores_of(const Carving& carving, const CarvedPiece& piece) {
  std::vector<Bore> bores;
  for (const MemberFace& face : carving.carved) {
    const std::optional<Bore> bore = as_bore(face);
    if (!bore || (bore->is_cone() && !is_off_apex(piece, *bore))) return {};
    bores.push_back(*bore);
  }
  return bores;
}

}  // namespace

std::vector<Carving> csg_carvings(const Csg& solid) {
  try {
    return Carver(solid).all();
  } catch (const NotPossible&) {
    return {};
  }
}

std::vector<CarvedPiece> csg_carved_pieces(const Csg& solid) {
  std::vector<CarvedPiece> pieces;
  for (Carving& carving : csg_carvings(solid)) {
    CarvedPiece piece{std::move(carving.body.shape), carving.body.X_SM, {}, {}, {}};
    for (const MemberFace& round : carving.carved) piece.carved.push_back(round.quadric);
    piece.bores = bores_of(carving, piece);
    pieces.push_back(std::move(piece));
  }
  find_seams(pieces, size_of(solid));
  return pieces;
}

}  // namespace volcontact
