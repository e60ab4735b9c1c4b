// SPDX-License-Identifier: Apache-2.0
#include "core/search/search_cases.h"

#include <algorithm>

namespace volcontact::test {
namespace {

// To the nearest 5 cm.
Vec3 on_lattice(const Vec3& p) { return 0.05 * (20.0 * p).rounded(); }

constexpr std::uint64_t kPoses = 20;  // of a pair of composed solids

/// Draws solids whose sizes now and then are those of `like_`, and poses that make features meet.
class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}

  /// Two solids, and whether their features are to meet.
  SearchCase solids(SearchFamily family) {
    SearchCase c{.family = family, .a = {}, .b = {}, .X_AB = {}};
    switch (family) {
      case SearchFamily::kRandom:
      case SearchFamily::kSpecial:
        c.special = family == SearchFamily::kSpecial;
        c.a = primitive(false);
        if (c.special) share_sizes_of(c.a);
        c.b = primitive(is_unbounded(c.a));
        break;
      case SearchFamily::kCones:
        c.a = sharp_cone();
        if (chance(0.5)) share_sizes_of(c.a);
        c.b = chance(0.3) ? sharp_cone() : primitive(false);
        c.special = chance(0.5);
        break;
      case SearchFamily::kThin:
        thin_ = random_.log_uniform(1e-4, 0.1);
        c.a = primitive(true);
        if (chance(0.7)) thin_ = 1.0;
        if (chance(0.5)) share_sizes_of(c.a);
        c.b = primitive(false);
        c.special = chance(0.5);
        break;
      case SearchFamily::kBored:
        c.a = bored();
        if (chance(0.5)) share_sizes_of(c.a);
        c.b = chance(0.15) ? bored() : primitive(false);
        c.special = chance(0.7);
        break;
      case SearchFamily::kComposed: {
        aligned_ = c.special = chance(0.5);
        const double kind = random_.uniform();
        c.a = tree(kind < 0.45 ? 1 : kind < 0.75 ? 2 : kind < 0.93 ? 3 : 4);
        c.b = chance(0.4) ? tree(chance(0.7) ? 1 : 2) : primitive(false);
        break;
      }
      case SearchFamily::kMeshes:
        c.a = mesh();
        if (chance(0.5)) share_sizes_of(c.a);
        c.b = chance(0.35) ? mesh() : chance(0.8) ? primitive(false) : bored();
        c.special = chance(0.6);
        break;
      case SearchFamily::kSlender:
        c.a = mesh();
        if (chance(0.3)) share_sizes_of(c.a);
        thin_ = random_.log_uniform(0.02, 0.3);
        c.b = primitive(false);
        c.special = chance(0.6);
        break;
    }
    return c;
  }

  /// A pose for them, and in many families the two in either order.
  SearchCase placed(SearchCase c) {
    const bool on_grid = c.family == SearchFamily::kComposed;
    c.X_AB = !c.special ? any_pose(c.a, c.b) : on_grid ? grid_pose() : special_pose(c.a, c.b);
    if (chance(0.5)) return c;
    std::swap(c.a, c.b);
    c.X_AB = c.X_AB.inverse();
    return c;
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  template <typename T>
  T one_of(std::initializer_list<T> all) {
    return all.begin()[pick(all.size())];
  }
  std::size_t pick(std::size_t count) {
    return static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(count)));
  }
  // 0, or 1e-15 to 1e-6 to either side.
  double hair() {
    if (chance(0.5)) return 0.0;
    return random_.log_uniform(1e-15, 1e-6) * (chance(0.5) ? 1.0 : -1.0);
  }
  void share_sizes_of(const SearchSolid& solid) {
    like_ = solid.radii;
    like_.insert(like_.end(), solid.heights.begin(), solid.heights.end());
  }
  static bool is_unbounded(const SearchSolid& solid) {
    return std::holds_alternative<HalfSpace>(solid.shape);
  }
  double size() {
    if (!like_.empty() && chance(0.35)) {
      const double length = like_[pick(like_.size())] + hair();
      if (length > 1e-3) return length;
    }
    if (chance(0.5)) return one_of({0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4});
    return random_.uniform(0.05, 0.4);
  }
  // One of the sizes that may be thin.
  double slight() { return thin_ < 1.0 ? thin_ * size() : size(); }
  Vec3 sizes() {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = size();
    if (thin_ < 1.0) {
      v[static_cast<int>(pick(3))] *= thin_;
      if (chance(0.3)) v[static_cast<int>(pick(3))] *= 0.1;
    }
    return v;
  }

  SearchSolid primitive(bool bounded) {
    const bool flat = chance(0.5);  // of the two sizes of a round solid, which one is slight
    switch (pick(bounded ? 8 : 9)) {
      case 0:
        if (thin_ < 1.0) return search_ellipsoid(sizes());
        return search_sphere(size());
      case 1:
        return search_ellipsoid(sizes());
      case 2: {
        const double r = flat ? size() : slight();
        return search_capsule(r, flat ? slight() : size());
      }
      case 3: {
        const double r = flat ? size() : slight();
        return search_cylinder(r, flat ? slight() : size());
      }
      case 4: {
        const double bottom = flat ? size() : slight();
        const double top = flat ? size() : slight();
        return search_frustum(bottom, top, flat ? slight() : size());
      }
      case 5:
        return search_box(sizes());
      case 6: {
        const double major = size();
        double minor = std::min(major, slight());
        if (chance(0.7)) minor = std::min(minor, 0.5 * major);
        return search_torus(major, minor);
      }
      case 7:
        return search_polytope(cloud());
      default:
        return search_half_space();
    }
  }
  std::vector<Vec3> cloud() {
    std::vector<Vec3> points;
    const std::size_t count = 4 + pick(14);
    const Vec3 stretch = sizes();
    const bool on_grid = chance(0.2);
    while (points.size() < count) {
      Vec3 p = random_.direction().cwiseProduct(stretch);
      if (on_grid) p = on_lattice(p);
      points.push_back(p);
    }
    const auto flat = [&points] {
      Mat3 spread = Mat3::Zero();
      for (const Vec3& p : points) spread += outer(p - points[0], p - points[0]);
      return std::abs(spread.determinant()) < 1e-6 * std::pow(spread.trace(), 3);
    };
    if (!on_grid || !flat()) return points;
    for (Vec3& p : points) p = random_.direction().cwiseProduct(stretch);
    return points;
  }
  SearchSolid sharp_cone() {
    const double wide = size(), h = chance(0.2) ? random_.log_uniform(1e-4, 0.05) : size();
    const double share = one_of({0.0, 0.0, 1e-6, 1e-3, 0.01, 0.1, 0.5});
    const double tip = share * wide;
    return chance(0.5) ? search_frustum(wide, tip, h) : search_frustum(tip, wide, h);
  }

  static Pose along_z(double z) { return {Mat3::Identity(), Vec3(0.0, 0.0, z)}; }

  // Parts with holes about their z axis, some elsewhere.
  SearchSolid bored() {
    const double r = size(), h = size(), wall = random_.uniform(0.02, 0.3);
    const double out = r + wall;
    const double longer = out + 0.05 * std::round(20.0 * size());
    const SearchSolid block =
        chance(0.6) ? search_box(Vec3(out, longer, h)) : search_cylinder(out, h);
    const SearchSolid bore = search_cylinder(r, one_of({h + 0.1, 2.0 * h, 2.0 * h + 0.1}));
    switch (pick(8)) {
      case 0:
      case 1:
        return block - bore;
      case 2:  // blind
        return block - posed(search_cylinder(r, h), along_z(random_.uniform(0.2, 1.0) * h));
      case 3:  // counterbored
        return block - search_cylinder(0.6 * r, 2.0 * h) -
               posed(search_cylinder(r, h), along_z(random_.uniform(0.8, 1.6) * h));
      case 4: {  // chamfered
        const double c = std::min(0.9 * wall, 0.4 * h);
        return block - bore - posed(search_frustum(r, r + c, 0.5 * c), along_z(h - 0.5 * c));
      }
      case 5: {  // a cup
        const double floor = random_.uniform(0.1, 0.9) * h;
        const double low = chance(0.3) ? 0.0 : random_.uniform(0.3, 1.0) * r;
        return block - posed(search_frustum(low, r, h), along_z(h + floor - 1e-3));
      }
      case 6: {  // a socket
        return block - posed(search_sphere(r), along_z(h * random_.uniform(0.5, 1.5)));
      }
      default: {  // two bores
        const Pose aside{Mat3::Identity(), Vec3(0.5 * r, 0.0, 0.0)};
        return block - search_cylinder(0.3 * r, 2.0 * h) -
               posed(search_cylinder(random_.uniform(0.1, 0.6) * r, 2.0 * h), aside);
      }
    }
  }

  SearchSolid tree(int depth) {
    if (depth == 0) {
      SearchSolid member = chance(0.85) ? simple_member() : primitive(true);
      if (chance(0.15)) return member;
      return posed(member, aligned_ ? grid_pose() : random_.pose(0.2));
    }
    const SearchSolid a = tree(depth - 1);
    const SearchSolid b = tree(chance(0.6) ? 0 : depth - 1);
    const double kind = random_.uniform();
    return kind < 0.3 ? a + b : kind < 0.75 ? a - b : a & b;
  }
  SearchSolid simple_member() {
    switch (pick(5)) {
      case 0:
        return search_sphere(size());
      case 1: {
        const double r = size(), top = chance(0.2) ? 0.0 : size();
        return search_frustum(r, top, size());
      }
      case 2: {
        const double r = size();
        return search_cylinder(r, size());
      }
      default:
        return search_box(sizes());
    }
  }
  SearchSolid mesh() {
    switch (pick(4)) {
      case 0:
        return search_hull_mesh(cloud());
      case 1: {
        const double outer = size(), inner = outer * random_.uniform(0.2, 0.9), half = size();
        return search_ring_mesh(inner, outer, half, 3 + static_cast<int>(pick(10)));
      }
      default: {
        const Vec3 half = sizes();
        return search_box_mesh(half, 1 + static_cast<int>(pick(2)));
      }
    }
  }

  // ---- Poses
  // -------------------------------------------------------------------------------------

  Pose any_pose(const SearchSolid& a, const SearchSolid& b) {
    if (!is_unbounded(a) && !is_unbounded(b) && chance(0.35)) {
      Pose X = random_.pose(0.7 * std::max(a.size, b.size));
      X.translation += a.implicit.middle - X.rotation * b.implicit.middle;
      return X;
    }
    const Mat3 r = random_.rotation();
    const Vec3 e = is_unbounded(a)   ? Vec3(0.0, 0.0, 1.0)
                   : is_unbounded(b) ? Vec3(-r.col(2))
                                     : random_.direction();
    const double depth = random_.log_uniform(1e-6, 0.7) * std::min(a.size, b.size);
    const double apart = height(a, e) + height(b, -(r.transpose() * e)) - depth;
    const Vec3 across = random_.in_box(0.3 * (a.size + b.size));
    const double share = chance(0.5) ? 1.0 : 0.1;
    return {r, apart * e + share * (across - across.dot(e) * e)};
  }
  // Of a half-space along its own normal: 0, which rounding of the direction would make infinite.
  static double height(const SearchSolid& solid, const Vec3& e) {
    if (is_unbounded(solid)) return 0.0;
    return std::visit([&e](const auto& s) { return s.support_height(e); }, solid.shape);
  }

  Mat3 tilted(const Mat3& r) {
    const double angle = chance(0.5) ? 0.0 : hair();
    return angle != 0.0 ? Mat3(turn(random_.direction(), angle) * r) : r;
  }
  // A rotation that maps axes to axes, or turns about z.
  Mat3 special_rotation() {
    const double kind = random_.uniform();
    Mat3 r = Mat3::Identity();
    if (kind < 0.1) r = one_of({turn(Vec3::UnitX(), 0.25 * kPi), turn(Vec3::UnitX(), kPi / 3.0)});
    if (kind >= 0.1 && kind < 0.35) r = Vec3(1.0, -1.0, -1.0).asDiagonal();
    if (kind >= 0.35 && kind < 0.5) r = Mat3(1, 0, 0, 0, 0, 1, 0, -1, 0);
    if (kind >= 0.5 && kind < 0.6) r = Mat3(0, 0, 1, 0, 1, 0, -1, 0, 0);
    if (chance(0.5)) r = r * turn(Vec3::UnitZ(), random_.uniform(0.0, 2.0 * kPi));
    if (chance(0.1)) r = turn(Vec3::UnitZ(), random_.uniform(0.0, 2.0 * kPi)) * r;
    return tilted(r);
  }
  double feature(const std::vector<double>& all) {
    return all.empty() || chance(0.2) ? 0.0 : all[pick(all.size())];
  }
  Pose special_pose(const SearchSolid& a, const SearchSolid& b) {
    const double ra = feature(a.radii), rb = feature(b.radii);
    const double za = feature(a.heights) * (chance(0.5) ? 1.0 : -1.0);
    const double zb = feature(b.heights) * (chance(0.5) ? 1.0 : -1.0);
    const double rim = std::sqrt(std::abs(ra * ra - rb * rb));
    double across = one_of({0.0, 0.0, 0.0, ra + rb, std::abs(ra - rb), ra, rb, rim}) + hair();
    if (chance(0.15)) across = random_.uniform(0.0, ra + rb);
    double along = za - zb + hair();
    if (chance(0.2)) along = one_of({za - rim, za + rim - zb, ra - zb, za - rb}) + hair();
    if (chance(0.15)) along = random_.uniform(-1.0, 1.0) * (std::abs(za) + std::abs(zb));
    Vec3 way = one_of({Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0).normalized()});
    if (chance(0.2)) way = turn(Vec3::UnitZ(), random_.uniform(0.0, 2.0 * kPi)) * way;
    return {special_rotation(), across * way + Vec3(0.0, 0.0, along)};
  }
  Pose grid_pose() {
    Vec3 at = random_.in_box(0.25);
    at = on_lattice(at);
    if (chance(0.2)) at[static_cast<int>(pick(3))] += hair();
    Mat3 r = Mat3::Zero();
    const int first = static_cast<int>(pick(3)),
              second = (first + 1 + static_cast<int>(pick(2))) % 3;
    r(first, 0) = chance(0.5) ? 1.0 : -1.0;
    r(second, 1) = chance(0.5) ? 1.0 : -1.0;
    r.col(2) = r.col(0).cross(r.col(1));
    if (chance(0.3)) r = r * turn(Vec3::UnitZ(), random_.uniform(0.0, 2.0 * kPi));
    return {r, at};
  }

  Random random_;
  std::vector<double> like_;
  double thin_ = 1.0;
  bool aligned_ = false;
};

}  // namespace

const char* to_string(SearchFamily family) {
  constexpr const char* kNames[] = {"random", "special",  "cones",  "thin",
                                    "bored",  "composed", "meshes", "slender"};
  return kNames[static_cast<int>(family)];
}

SearchCase SearchCases::operator[](std::uint64_t index) {
  const auto drawer = [this](std::uint64_t number, std::uint64_t kind) {
    Random mixed(seed_ * 0x100000001b3u + 0x1000193u * number + 0x51ed27u * kind +
                 static_cast<std::uint64_t>(family_));
    return Drawer(static_cast<std::uint64_t>(mixed.uniform(0.0, 0x1p52)));
  };
  const std::uint64_t group = index / (family_ == SearchFamily::kComposed ? kPoses : 1);
  if (group != group_) {
    group_ = ~std::uint64_t{0};  // not drawn, should this one be no solid
    pair_ = drawer(group, 1).solids(family_);
    group_ = group;
  }
  return drawer(index, 2).placed(pair_);
}

}  // namespace volcontact::test
