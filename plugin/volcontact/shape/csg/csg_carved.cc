// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_carved.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "volcontact/shape/csg/csg_bores.h"

namespace volcontact {
namespace {

using Operation = Csg::Operation;

constexpr std::size_t kMostPieces = 64;

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
  Carvings met(const Carving& piece, const Carving& other) const;
  Carving part(const Carving& of, PosedShape body) const;
  bool reach(const PartHull& hull, const std::vector<MemberFace>& faces) const;
  bool inside(const Carving& piece, const MemberFace& round) const;

  const Csg& solid_;
  const double size_;
};

std::vector<std::vector<MemberFace>> faces_of(const PosedShape& body) {
  return member_faces(body.shape, body.X_SM);
}

bool is_carved_by(const Carving& piece, const MemberFace& face) {
  return std::any_of(piece.carved.begin(), piece.carved.end(), [&](const MemberFace& round) {
    return round.quadric.constant == face.quadric.constant &&
           round.quadric.linear == face.quadric.linear &&
           round.quadric.hessian == face.quadric.hessian;
  });
}

Carvings Carver::of_member(const Csg::Member& member) const {
  if (!is_made_of_faces(member.shape)) throw NotPossible{};
  if (faces_of({member.shape, member.X_SM}).empty()) return {};  // of no volume
  return {Carving({member.shape, member.X_SM})};
}

// Whether the interior of a convex set with these faces may reach the hull.
bool Carver::reach(const PartHull& hull, const std::vector<MemberFace>& faces) const {
  PartHull rest = hull;
  for (const MemberFace& face : faces) {
    if (rest.stays_above(face, -face.tolerance(size_))) return false;
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
    if (!result.hull.stays_above(round, -round.tolerance(size_))) result.carved.push_back(round);
  }
  return result;
}

void Carver::carve(Carving piece, const MemberFace& round, Carvings& out) const {
  if (inside(piece, round)) return;
  if (piece.hull.stays_above(round, -round.tolerance(size_)))
    return out.push_back(std::move(piece));
  for (const MemberFace& other : piece.carved) {
    const std::optional<MemberFace> plane = csg_crossing(round, other, size_);
    if (!plane || !(piece.hull.most(*plane) > plane->tolerance(size_)) ||
        piece.hull.stays_above(*plane, -plane->tolerance(size_))) {
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

// The part of a piece within the body of another one, carved by both: several pieces where the
// carved faces of the two cross.
Carvings Carver::met(const Carving& piece, const Carving& other) const {
  const auto convex_parts = faces_of(other.body);
  const bool apart =
      std::none_of(convex_parts.begin(), convex_parts.end(),
                   [&](const std::vector<MemberFace>& faces) { return reach(piece.hull, faces); });
  if (apart) return {};
  if (convex_parts.size() != 1) throw NotPossible{};
  Carving rest = piece;
  for (const MemberFace& face : convex_parts[0]) {
    if (face.kind != MemberFace::Kind::kPlane) {
      if (!inside(rest, face)) throw NotPossible{};
      continue;
    }
    Split halves = split(rest.body, face, size_);
    if (!halves.possible) throw NotPossible{};
    if (!halves.inside) return {};
    rest = part(rest, std::move(*halves.inside));
  }
  Carvings one{std::move(rest)};
  for (const MemberFace& round : other.carved) {
    Carvings next;
    for (Carving& carving : one) carve(std::move(carving), round, next);
    one.swap(next);
  }
  return one;
}

Carvings Carver::met(const Carvings& a, const Carvings& b) const {
  Carvings all;
  for (const Carving& one : a) {
    for (const Carving& two : b) {
      Carvings both;
      try {
        both = met(one, two);
      } catch (const NotPossible&) {
        both = met(two, one);
      }
      std::move(both.begin(), both.end(), std::back_inserter(all));
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
                return &f == &other || !hull.stays_above(f, -f.tolerance(size));
              });
          if (meets) seam.covered.push_back(region_beside(pieces[j], faces[j], &other));
        }
      }
      if (!seam.covered.empty()) pieces[i].seams.push_back(std::move(seam));
    }
  }
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
    piece.bores = csg_bores(carving, piece);
    pieces.push_back(std::move(piece));
  }
  find_seams(pieces, size_of(solid));
  return pieces;
}

}  // namespace volcontact
