// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/sweep_solid.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

using Kind = SweepFace::Kind;

constexpr double kSameSurface = 1e-11;  // of directions, and of places per size of the box

Kind kind_of(const RoundFace& round) {
  if (round.cone) return Kind::kCone;
  return round.map.row(2).isZero(0.0) ? Kind::kTube : Kind::kBall;
}

enum class Where { kWithin, kBeyond, kThrough };

// Where a box about the origin lies, of a torus: from the distance of its middle.
Where place_of_torus(const SweepFace& face, const Vec3& half) {
  const Vec3 d = -face.round.center;
  const double z = face.normal.dot(d), rho = (d - z * face.normal).norm();
  const double distance = std::hypot(rho - face.major, z) - face.minor, reach = half.norm();
  return distance > reach ? Where::kBeyond : distance < -reach ? Where::kWithin : Where::kThrough;
}

// The same of the convex inside of a face: a box is within when its corners are, and beyond when a
// tangent plane says so.
Where place_of(const SweepFace& face, const Vec3& half) {
  if (face.kind == Kind::kTorus) return place_of_torus(face, half);
  double most = -kInfinity, least = kInfinity;
  if (face.kind == Kind::kPlane) {
    const double reach = face.normal.cwiseAbs().dot(half);
    most = reach - face.offset;
    least = -reach - face.offset;
  } else {
    const Vec3 middle = face.round.map * -face.round.center;
    Vec3 out(middle.x(), middle.y(), face.kind == Kind::kBall ? middle.z() : 0.0);
    const double length = out.norm();
    out = length > 0.0 ? Vec3(out / length) : Vec3::Zero();
    const bool cone = face.kind == Kind::kCone;
    for (int i = 0; i < 8; ++i) {
      const Vec3 y = face.round.map * (half.cwiseProduct(corner_signs(i)) - face.round.center);
      const double level = cone ? y.z() : 1.0;
      const double across = face.kind == Kind::kBall ? y.norm() : std::hypot(y.x(), y.y());
      most = std::max(most, across - level);
      least = std::min(least, out.dot(y) - level);
    }
  }
  return most < 0.0 ? Where::kWithin : least > 0.0 ? Where::kBeyond : Where::kThrough;
}

}  // namespace

double SweepFace::value(const Vec3& x) const {
  if (kind == Kind::kPlane) return normal.dot(x) - offset;
  if (kind != Kind::kTorus) return round(x);
  const Vec3 d = x - round.center;
  const double z = normal.dot(d), rho = (d - z * normal).norm();
  return (rho - major) * (rho - major) + (z - minor) * (z + minor);
}

bool SweepSolids::read(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB,
                       const Vec3& box) {
  faces.clear();
  parts.clear();
  half = box;
  for (auto& steps : steps_) steps.clear();
  if (!read_solid(a, X_WA, Owner::kA) || !read_solid(b, X_WB, Owner::kB)) return false;
  prune();
  for (const Owner owner : {Owner::kA, Owner::kB}) fill_table(owner);
  find_twins();
  return true;
}

bool SweepSolids::read_solid(const Shape& shape, const Pose& X_WS, Owner owner) {
  std::vector<Step>& steps = steps_[index(owner)];
  return std::visit(
      [&](const auto& solid) {
        using S = std::decay_t<decltype(solid)>;
        if constexpr (std::is_same_v<S, Csg>) {
          for (const Csg::Step& step : solid.steps()) {
            if (step.member >= 0) {
              const Csg::Member& member = solid.members()[step.member];
              if (!read_member(member.shape, X_WS * member.X_SM, owner)) return false;
              continue;
            }
            const bool meet = step.operation == Csg::Operation::kIntersection;
            const bool join = step.operation == Csg::Operation::kUnion;
            steps.push_back({join   ? Join::kUnion
                             : meet ? Join::kIntersection
                                    : Join::kDifference,
                             0});
          }
          return true;
        } else if constexpr (HasFaces<S> || HasParts<S>) {
          const std::size_t before = parts.size();
          add_parts(solid, X_WS, owner);
          if (parts.size() > kMostParts) return false;
          std::uint64_t mask = 0;
          for (std::size_t i = before; i < parts.size(); ++i) mask |= std::uint64_t{1} << i;
          steps.push_back({Join::kLeaf, mask});
          return true;
        } else {
          return false;
        }
      },
      shape);
}

bool SweepSolids::read_member(const SimpleShape& shape, const Pose& X_WM, Owner owner) {
  const std::size_t before = parts.size();
  std::visit([&](const auto& solid) { add_parts(solid, X_WM, owner); }, shape);
  if (parts.size() > kMostParts) return false;
  std::uint64_t mask = 0;
  for (std::size_t i = before; i < parts.size(); ++i) mask |= std::uint64_t{1} << i;
  steps_[index(owner)].push_back({Join::kLeaf, mask});
  return true;
}

// Takes the parts of a solid posed in W, which the solid writes by itself: solid.h, "write_parts".
class SweepSolids::PartWriter {
 public:
  PartWriter(SweepSolids& to, const Pose& X_WM, Owner owner)
      : to_(to), X_(X_WM), owner_(owner), first_(static_cast<int>(to.faces.size())) {}

  void plane(const Vec3& normal_M, double offset, bool seam) {
    SweepFace& face = add(Kind::kPlane);
    face.normal = X_.rotation * normal_M;
    face.offset = offset + face.normal.dot(X_.translation);
    face.seam = seam;
  }
  void tube(int axis, double radius, const Vec3& center_M) {
    const double scale = 1.0 / radius;
    RoundFace round{Mat3::Zero(), X_ * center_M, owner_};
    round.map.set_row(0, scale * X_.rotation.col((axis + 1) % 3));
    round.map.set_row(1, scale * X_.rotation.col((axis + 2) % 3));
    add(Kind::kTube).round = round;
  }
  void ball(double radius, const Vec3& center_M) {
    add(Kind::kBall).round = {1.0 / radius * X_.rotation.transpose(), X_ * center_M, owner_};
  }
  void ring(double major, double minor) {
    SweepFace& face = add(Kind::kTorus);
    face.normal = X_.rotation.col(2);
    face.round.center = X_.translation;
    face.major = major;
    face.minor = minor;
  }
  void end_part() {
    to_.end_part(begin_ < 0 ? first_ : begin_, owner_);
    begin_ = static_cast<int>(to_.faces.size());
    ++parts_;
  }
  /// Parts of one solid go on in each other without an edge.
  void end() {
    if (parts_ < 2) return;
    for (auto f = static_cast<std::size_t>(first_); f < to_.faces.size(); ++f) {
      to_.faces[f].smooth = -1 - first_;
    }
  }

 private:
  SweepFace& add(Kind kind) {
    SweepFace& face = to_.faces.emplace_back();
    face.kind = kind;
    face.owner = owner_;
    face.smooth = static_cast<int>(to_.faces.size());
    return face;
  }

  SweepSolids& to_;
  const Pose& X_;
  Owner owner_;
  int first_, begin_ = -1, parts_ = 0;
};

template <typename S>
void SweepSolids::add_parts(const S& solid, const Pose& X_WM, Owner owner) {
  if constexpr (HasParts<S>) {
    PartWriter writer(*this, X_WM, owner);
    solid.write_parts(writer);
    writer.end();
  } else {
    const auto first = static_cast<int>(faces.size());
    const auto add = [&](Kind kind) -> SweepFace& {
      SweepFace& face = faces.emplace_back();
      face.kind = kind;
      face.owner = owner;
      face.smooth = static_cast<int>(faces.size());
      return face;
    };
    set_.clear();
    FaceWriter(set_, X_WM, owner).write(solid);
    for (const PlaneFace& plane : set_.planes) {
      SweepFace& face = add(Kind::kPlane);
      face.normal = plane.normal;
      face.offset = plane.offset;
    }
    for (const RoundFace& round : set_.rounds) add(kind_of(round)).round = round;
    end_part(first, owner);
  }
}

void SweepSolids::end_part(int first, Owner owner) {
  parts.push_back({first, static_cast<int>(faces.size()), owner});
}

// Drops faces that hold all of the box, and parts that hold all of it or nothing.
void SweepSolids::prune() {
  std::size_t kept = 0;
  std::uint64_t dropped = 0, within = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    SweepPart& part = parts[p];
    const auto begin = static_cast<int>(kept);
    bool beyond = false;
    for (int f = part.first; f < part.last && !beyond; ++f) {
      const Where where = place_of(faces[f], half);
      beyond = where == Where::kBeyond;
      if (where == Where::kThrough) faces[kept++] = faces[f];
    }
    if (beyond) kept = static_cast<std::size_t>(begin);
    part.first = begin;
    part.last = static_cast<int>(kept);
    const std::uint64_t bit = std::uint64_t{1} << p;
    if (part.first == part.last) dropped |= bit;
    if (part.first == part.last && !beyond) within |= bit;
  }
  faces.resize(kept);
  drop_parts(dropped, within);
}

void SweepSolids::drop_parts(std::uint64_t dropped, std::uint64_t within) {
  const auto count = static_cast<int>(parts.size());
  for (auto& steps : steps_) {
    for (Step& step : steps) {
      step.always = (step.mask & within) != 0;
      std::uint64_t mask = 0;
      for (int p = 0, next = 0; p < count; ++p) {
        if (dropped >> p & 1u) continue;
        mask |= (step.mask >> p & 1u) << next++;
      }
      step.mask = mask;
    }
  }
  std::size_t next = 0;
  for (int p = 0; p < count; ++p) {
    if (!(dropped >> p & 1u)) parts[next++] = parts[p];
  }
  parts.resize(next);
}

void SweepSolids::fill_table(Owner owner) {
  constexpr int kMost = 6;  // 64 answers
  Table& table = tables_[index(owner)];
  const auto mine = [owner](const SweepPart& part) { return part.owner == owner; };
  const auto count = static_cast<int>(std::count_if(parts.begin(), parts.end(), mine));
  table = Table{};
  if (count > kMost) return;
  table.filled = true;
  table.first = static_cast<int>(std::find_if(parts.begin(), parts.end(), mine) - parts.begin());
  if (count == 0) table.first = 0;
  table.mask = (std::uint64_t{1} << count) - 1;
  for (std::uint64_t in = 0; in <= table.mask; ++in) {
    if (evaluate(owner, in << table.first)) table.answers |= std::uint64_t{1} << in;
  }
}

void SweepSolids::find_twins() {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    faces[i].twin = static_cast<int>(i);
    faces[i].side = 1;
    for (std::size_t j = 0; j < i; ++j) {
      if (faces[j].twin != static_cast<int>(j)) continue;
      int side = 1;
      if (!same_surface(faces[i], faces[j], side)) continue;
      faces[i].twin = static_cast<int>(j);
      faces[i].side = side;
      break;
    }
  }
}

bool SweepSolids::same_surface(const SweepFace& one, const SweepFace& other, int& side) const {
  if (one.kind != other.kind) return false;
  const double size = half.norm();
  if (one.kind == Kind::kPlane) {
    side = one.normal.dot(other.normal) > 0.0 ? 1 : -1;
    return (one.normal - side * other.normal).norm() <= kSameSurface &&
           std::abs(one.offset - side * other.offset) <= kSameSurface * size;
  }
  if (one.kind == Kind::kTorus) {
    return one.normal.cross(other.normal).norm() <= kSameSurface &&
           (one.round.center - other.round.center).norm() <= kSameSurface * size &&
           std::abs(one.major - other.major) <= kSameSurface * size &&
           std::abs(one.minor - other.minor) <= kSameSurface * size;
  }
  // Forms of the same unit: those of round faces are fixed but for that of an ellipsoid.
  const auto form = [](const RoundFace& face) -> Mat3 {
    return face.map.transpose() * Vec3(1.0, 1.0, face.cone ? -1.0 : 1.0).asDiagonal() * face.map;
  };
  const Mat3 h = form(one.round), k = form(other.round);
  const double unit = h.norm();
  const Vec3 apart = one.round.center - other.round.center;
  if ((h - k).norm() > kSameSurface * unit) return false;
  if (one.kind == Kind::kCone) {
    return apart.norm() <= kSameSurface * size &&
           one.round.map.row(2).dot(other.round.map.row(2)) > 0.0;
  }
  return (h * apart).norm() <= kSameSurface * size * unit;
}

bool SweepSolids::evaluate(Owner owner, std::uint64_t in_parts) const {
  std::uint64_t stack = 0;
  for (const Step& step : steps_[index(owner)]) {
    if (step.join == Join::kLeaf) {
      stack = (stack << 1) | (step.always || (in_parts & step.mask) != 0 ? 1u : 0u);
      continue;
    }
    const std::uint64_t b = stack & 1u, a = (stack >> 1) & 1u;
    const std::uint64_t joined = step.join == Join::kUnion          ? a | b
                                 : step.join == Join::kIntersection ? a & b
                                                                    : a & (b ^ 1u);
    stack = ((stack >> 2) << 1) | joined;
  }
  return (stack & 1u) != 0;
}

}  // namespace volcontact
