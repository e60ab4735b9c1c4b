// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/window/convex_window.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/cholesky.h"
#include "volcontact/pair/convex/gjk.h"

namespace volcontact {
namespace {

// The faces as the kernel sees them from a point c: plain data, see SectionFaces.
struct ChordRound {
  double map[9], o[3];  // row by row; image of c
  double sign, value;   // of the last square; what the face's function is at c
  int owner;
  CapsulePart part;
};
struct ChordSeam {
  bool present;
  double axis[3], along, half_length;
};
constexpr int kMaxRounds = 6;
struct ChordFaces {
  const ChordPlane* planes;
  int plane_count;
  ChordRound rounds[kMaxRounds];
  int round_count = 0;
  ChordSeam seams[2];
};
struct ChordSums {
  double cubes, total, first[3], second[6], surface[2][4], longest, shortest;
};

constexpr double kFar = 1e300;
constexpr double kTiny = 1e-200;

// Axes through the corners of an icosahedron (6) and of a dodecahedron (10). With the weights 25
// and 27 of 840 for each end this integrates polynomials over the sphere exactly to degree 9
// (McLaren-type rule of 32 points; Stroud, Approximate Calculation of Multiple Integrals, U3: 9-1).
constexpr int kChordAxes = 16;
struct ChordAxes {
  double x[kChordAxes], y[kChordAxes], z[kChordAxes], weight[kChordAxes];
};
constexpr double kIco1 = 0.52573111211913361, kIco2 = 0.85065080835203993;  // (1, golden)
constexpr double kDod1 = 0.35682208977308993, kDod2 = 0.93417235896271570;  // (1/golden, golden)
constexpr double kCube = 0.57735026918962576;
constexpr double kIcoWeight = 25.0 / 840.0, kDodWeight = 27.0 / 840.0;
alignas(64) constexpr ChordAxes kAxes = {
    {0, 0, kIco1, kIco1, kIco2, -kIco2, 0, 0, kDod1, kDod1, kDod2, -kDod2, kCube, kCube, kCube,
     kCube},
    {kIco1, kIco1, kIco2, -kIco2, 0, 0, kDod1, kDod1, kDod2, -kDod2, 0, 0, kCube, kCube, -kCube,
     -kCube},
    {kIco2, -kIco2, 0, 0, kIco1, kIco1, kDod2, -kDod2, 0, 0, kDod1, kDod1, kCube, -kCube, kCube,
     -kCube},
    {kIcoWeight, kIcoWeight, kIcoWeight, kIcoWeight, kIcoWeight, kIcoWeight, kDodWeight, kDodWeight,
     kDodWeight, kDodWeight, kDodWeight, kDodWeight, kDodWeight, kDodWeight, kDodWeight,
     kDodWeight}};

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/window/convex_window_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {
namespace {

constexpr int kMaxRoundings = 12;  // how often the frame is made anew
constexpr int kMaxInLayer = 32;    // the same in a layer between plane faces
constexpr double kEven = 1.1;      // mean of squares of axes by the square of their mean, of a ball
constexpr double kRounding = 1e-12;  // of a common point, per its distance from both frames
constexpr int kMaxTurns = 5;         // in search of a place behind both planes of an edge
constexpr double kNearFace = 1e-3;   // of a start from a wall or both faces of an edge, per size
constexpr double kLeastEdge = 1e-6;  // squared sine between the two
constexpr int kMaxMoves = 8;         // from a common point on the faces into the overlap
constexpr double kFlush = 1e-6;      // faces that lean less, and overlap less, make a thin layer
constexpr double kRound = 3.5;       // longest by shortest way out of a well-rounded overlap
constexpr double kThinnest = 1e-14;  // squared relative length below which one rounding cannot see

struct Solid2 {
  ConvexView view;
  Pose X;
};

class WindowSearch {
 public:
  WindowSearch(const ConvexView& a, const ConvexView& b, const Pose& X_AB, SimdPath path,
               LinesFaces& faces)
      : solids_{{a, Pose{}}, {b, X_AB}}, path_(path), faces_(faces) {}

  LinesWindow run(bool look_inside) {
    LinesWindow window;
    write_faces();
    if (!sort_planes()) return window;
    for (Owner owner : {Owner::kA, Owner::kB}) {
      if (look_inside || count_planes(owner) > 0 || faces_.active.has_rounds(owner)) continue;
      window.kind = owner == Owner::kB ? LinesWindow::Kind::kAInB : LinesWindow::Kind::kBInA;
      return window;
    }
    if (!find_start(window.center)) return window;
    move_along_strip(window.center);
    round_off(window);
    return window;
  }

 private:
  const Solid2& solid(Owner owner) const { return solids_[index(owner)]; }

  void write_faces() {
    faces_.active.clear();
    faces_.idle.clear();
    for (Owner owner : {Owner::kA, Owner::kB}) {
      const Solid2& s = solid(owner);
      FaceWriter writer(faces_.active, s.X, owner);
      s.view.write_faces(writer);
    }
  }

  // From where to where a solid reaches.
  struct Span {
    Vec3 along;
    double low = 0.0, high = 0.0;
    const Solid2* solid = nullptr;
  };
  // Opposite faces come one after the other: the last span may be known but for its sign.
  static Span span_along(const Vec3& e, const Solid2& s, const Span& last) {
    if (last.solid == &s && last.along == -e) return {e, -last.high, -last.low, &s};
    return {e, -s.view.support_height(s.X, -e), s.view.support_height(s.X, e), &s};
  }

  // Sets aside the planes that the other solid does not reach; false when one separates the two.
  bool sort_planes() {
    std::vector<PlaneFace>& planes = faces_.active.planes;
    std::size_t kept = 0;
    Span span{Vec3::Zero()};
    for (const PlaneFace& plane : planes) {
      const Solid2& s = solid(other(plane.owner));
      if (s.view.bounded()) {
        span = span_along(plane.normal, s, span);
        if (span.low >= plane.offset) return false;
        // Of two faces in one plane A's stays.
        const double reach = span.high - plane.offset;
        const double rounding = kRounding * (std::abs(plane.offset) + s.X.translation.norm());
        if (reach <= (plane.owner == Owner::kA ? -2.0 * rounding : rounding)) {
          faces_.idle.push_back(plane);
          drop_rims_of(plane, rounding);
          continue;
        }
      }
      planes[kept++] = plane;
    }
    planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(kept), planes.end());
    return true;
  }

  void drop_rims_of(const PlaneFace& plane, double rounding) {
    std::erase_if(faces_.active.rims, [&](const Rim& rim) {
      return rim.owner == plane.owner &&
             std::abs(plane.normal.dot(rim.center) - plane.offset) <= rounding &&
             plane.normal.cross(rim.radius_u.cross(rim.radius_v)).norm() <=
                 kRounding * rim.radius_u.squaredNorm();
    });
  }

  int count_planes(Owner owner) const {
    return static_cast<int>(
        std::count_if(faces_.active.planes.begin(), faces_.active.planes.end(),
                      [=](const PlaneFace& plane) { return plane.owner == owner; }));
  }

  // Of the smaller solid, about.
  double size() const {
    return std::cbrt(
        std::min(solids_[0].view.own_metrics().volume, solids_[1].view.own_metrics().volume));
  }

  bool inside(const Vec3& x) const {
    for (const PlaneFace& plane : faces_.active.planes) {
      if (!(plane.normal.dot(x) < plane.offset)) return false;
    }
    for (const RoundFace& round : faces_.active.rounds) {
      if (!(value_at(round, x) < 0.0)) return false;
    }
    return true;
  }

  double value_at(const RoundFace& round, const Vec3& x) const {
    if (round.part == CapsulePart::kNone) {
      if (round.cone && !((round.map * (x - round.center)).z() > 0.0)) return 1.0;
      return round(x);
    }
    if (round.part != CapsulePart::kTube) return -1.0;
    const Segment& segment = faces_.active.capsule[index(round.owner)];
    const double along = segment.along(x);
    const double beyond = along - std::clamp(along, -segment.half_length, segment.half_length);
    const double scale2 = round.map.row(0).squaredNorm();
    return round(x) + scale2 * beyond * beyond;
  }

  // A common point: half way into the plane that a solid's deepest place lies behind, or the two
  // planes of an edge, or between the middles, or by the general method.
  bool find_start(Vec3& start) const {
    for (const PlaneFace& plane : faces_.active.planes) {
      if (!solid(other(plane.owner)).view.bounded()) continue;
      if (start_from(deepest(plane.owner, plane.normal), plane.owner, start)) return true;
    }
    for (Owner owner : {Owner::kA, Owner::kB}) {
      if (count_planes(owner) == 2 && start_at_edge(owner, start)) return true;
    }
    if (solids_[0].view.bounded() && solids_[1].view.bounded()) {
      return (find_common_point(solids_[0].view, solids_[1].view, solids_[1].X, start) &&
              move_inside(start)) ||
             start_in_layer(start);
    }
    for (const Solid2& s : solids_) {
      start = s.view.middle(s.X);
      if (s.view.bounded() && inside(start)) return true;
    }
    return false;
  }

  // The place of the other solid that lies deepest against `outward`.
  Vec3 deepest(Owner owner, const Vec3& outward) const {
    const Solid2& s = solid(other(owner));
    return s.view.support(s.X, -outward);
  }

  // From a place on the other solid towards its middle, as far as half way out of the owner's
  // planes.
  bool start_from(const Vec3& place, Owner owner, Vec3& start) const {
    const Solid2& s = solid(other(owner));
    const Vec3 inward = s.view.middle(s.X) - place;
    double way = 0.5;
    for (const PlaneFace& plane : faces_.active.planes) {
      if (plane.owner != owner) continue;
      const double depth = plane.offset - plane.normal.dot(place);
      const double speed = plane.normal.dot(inward);
      if (depth > 0.0 && speed > 0.0) way = std::min(way, 0.5 * depth / speed);
    }
    start = place + way * inward;
    return inside(start);
  }

  // Turns from one plane of an edge to the other until the deepest place lies behind both. False
  // position with halvings (Illinois).
  bool start_at_edge(Owner owner, Vec3& start) const {
    if (!solid(other(owner)).view.bounded()) return false;
    const PlaneFace* edge[2];
    int count = 0;
    for (const PlaneFace& plane : faces_.active.planes) {
      if (plane.owner == owner) edge[count++] = &plane;
    }
    Vec3 place;
    double least;
    // How much deeper behind the second plane.
    const auto lead = [&](double turn) {
      place = deepest(owner, (1.0 - turn) * edge[0]->normal + turn * edge[1]->normal);
      const double one = edge[0]->offset - edge[0]->normal.dot(place);
      const double two = edge[1]->offset - edge[1]->normal.dot(place);
      least = std::min(one, two);
      return two - one;
    };
    double t0 = 0.0, f0 = lead(t0), t1 = 1.0, f1 = lead(t1);
    if (!(f0 < 0.0 && f1 > 0.0)) return false;
    for (int step = 0; step < kMaxTurns; ++step) {
      const double t = t1 - f1 * (t1 - t0) / (f1 - f0), f = lead(t);
      if (least > 0.0) return start_from(place, owner, start);
      if ((f > 0.0) != (f1 > 0.0)) {
        t0 = t1;
        f0 = f1;
      } else {
        f0 *= 0.5;
      }
      t1 = t;
      f1 = f;
    }
    return false;
  }

  // An edge or the wall of a cylinder or cone that reaches next to nothing into the other solid,
  // and lies along it, overlaps in a thin strip: from a place at its end chords see that end alone.
  // Moves to the middle of the longest.
  void move_along_strip(Vec3& start) {
    const double near = kNearFace * size();
    strip_ = Vec3::Zero();
    const auto move = [&](const Vec3& along) {
      Vec3 place = start;
      if (!move_to_middle(along, place) || !inside(place)) return;
      start = place;
      const RayInterval span = common(start, along);
      const Vec3 half = 0.5 * (span.leave - span.enter) * along;
      if (half.squaredNorm() > strip_.squaredNorm()) strip_ = half;
    };
    const std::vector<PlaneFace>& planes = faces_.active.planes;
    for (std::size_t i = 1; i < planes.size(); ++i) {
      if (!(planes[i].offset - planes[i].normal.dot(start) < near)) continue;
      for (std::size_t j = 0; j < i; ++j) {
        if (planes[j].owner != planes[i].owner) continue;
        if (!(planes[j].offset - planes[j].normal.dot(start) < near)) continue;
        const Vec3 along = planes[i].normal.cross(planes[j].normal);
        if (along.squaredNorm() > kLeastEdge) move(along);
      }
    }
    for (const RoundFace& face : faces_.active.rounds) {
      const bool tube = !face.cone && face.map.row(2).isZero(0.0);
      if (!tube && !face.cone) continue;
      if (!(-face(start) < 2.0 * near * face.half_gradient(start).norm())) continue;
      move(tube ? Vec3(face.map.row(0)).cross(Vec3(face.map.row(1))) : start - face.center);
    }
  }

  // Between two faces that look at each other and are nearly in one plane. Along them a common
  // point is far easier to find than across: lengths across count by how thin the layer is.
  bool start_in_layer(Vec3& start) const {
    for (const PlaneFace& one : faces_.active.planes) {
      if (one.owner != Owner::kA) continue;
      for (const PlaneFace& two : faces_.active.planes) {
        if (two.owner != Owner::kB || (one.normal + two.normal).norm() > kFlush) continue;
        const Solid2 &a = solid(Owner::kA), &b = solid(Owner::kB);
        // A long solid leans far into a face that hardly reaches into its own.
        const double depth = std::min(one.offset + b.view.support_height(b.X, -one.normal),
                                      two.offset + a.view.support_height(a.X, -two.normal));
        if (!(depth > 0.0 && depth < kFlush * size())) continue;
        const FlushFaces faces{one.normal, one.offset, two.normal, depth, size()};
        if (!find_common_point_in_layer(a.view, b.view, b.X, faces, start)) continue;
        // Off the edges, along the layer. A place on one of the two faces may be out of it by
        // rounding, and so may be all of a line along it.
        for (int step = 0; step < kMaxMoves; ++step) {
          if (!inside(start)) {
            go_between(one, two, start);
            move_to_middle(one.normal, start);
          }
          move_to_middle(one.normal, start);
          if (inside(start)) return true;
          const Vec3 way = way_from_faces(start, &one, &two);
          if (!move_to_middle(way - way.dot(one.normal) * one.normal, start)) break;
        }
        if (inside(start)) return true;
      }
    }
    return false;
  }

  // Half way between two faces that look at each other.
  static void go_between(const PlaneFace& one, const PlaneFace& two, Vec3& x) {
    const double to_one = one.offset - one.normal.dot(x), to_two = two.offset - two.normal.dot(x);
    x += 0.5 * (to_one - to_two) * one.normal;
  }

  // A common point may lie on faces, at worst in a sharp corner of the overlap: from there go away
  // from all faces that are near, half way to the other side, until none is.
  bool move_inside(Vec3& x) const {
    for (int step = 0; step < kMaxMoves; ++step) {
      if (inside(x)) return true;
      const Vec3 d = way_from_faces(x, nullptr, nullptr);
      if (!(d.norm() > 0.0)) return false;
      if (!move_to_middle(d, x)) return false;
    }
    return inside(x);
  }

  // To the middle of the overlap on the line x + t d; false where it has none.
  bool move_to_middle(const Vec3& d, Vec3& x) const {
    const RayInterval span = common(x, d);
    if (!(span.enter < span.leave)) return false;
    x += 0.5 * (span.enter + span.leave) * d;
    return true;
  }
  RayInterval common(const Vec3& x, const Vec3& d) const {
    const RayInterval in_a = solids_[0].view.ray(solids_[0].X, x, d),
                      in_b = solids_[1].view.ray(solids_[1].X, x, d);
    return {std::max(in_a.enter, in_b.enter), std::min(in_a.leave, in_b.leave)};
  }

  // How far a place inside is from the nearest face, about.
  double depth_of(const Vec3& x) const {
    double least = size();
    for (const PlaneFace& plane : faces_.active.planes) {
      least = std::min(least, plane.offset - plane.normal.dot(x));
    }
    for (const RoundFace& face : faces_.active.rounds) {
      const double slope = 2.0 * face.half_gradient(x).norm();
      if (slope > 0.0) least = std::min(least, -value_at(face, x) / slope);
    }
    return std::max(least, 0.0);
  }

  // The direction that leaves every near face, but for two, at the largest angle. The size of the
  // solids counts, too: a face may pass through the origin of both.
  Vec3 way_from_faces(const Vec3& x, const PlaneFace* but_one, const PlaneFace* but_two) const {
    const double distance = kRounding * (x.norm() + solids_[1].X.translation.norm() + size());
    faces_.near.clear();
    for (const PlaneFace& plane : faces_.active.planes) {
      if (&plane == but_one || &plane == but_two) continue;
      if (plane.normal.dot(x) - plane.offset > -distance) faces_.near.push_back(plane.normal);
    }
    for (const RoundFace& round : faces_.active.rounds) {
      if (round.cone && (x - round.center).norm() <= distance) {  // the apex
        faces_.near.push_back(-round.map.row(2).normalized());
        continue;
      }
      const Vec3 g = round.half_gradient(x);
      if (value_at(round, x) > -2.0 * distance * g.norm()) faces_.near.push_back(g.normalized());
    }
    if (faces_.near.empty()) return Vec3::Zero();
    return -nearest_in_hull(faces_.near);
  }

  void look_from(const Vec3& c) {
    faces_.seen.clear();
    for (const PlaneFace& p : faces_.active.planes) {
      faces_.seen.push_back(
          {{p.normal.x(), p.normal.y(), p.normal.z()}, p.offset - p.normal.dot(c), index(p.owner)});
    }
    view_.planes = faces_.seen.data();
    view_.plane_count = static_cast<int>(faces_.seen.size());
    view_.round_count = 0;
    for (const RoundFace& f : faces_.active.rounds) {
      ChordRound& r = view_.rounds[view_.round_count++];
      const Vec3 o = f.map * (c - f.center);
      for (int i = 0; i < 3; ++i) {
        r.o[i] = o[i];
        for (int j = 0; j < 3; ++j) r.map[3 * i + j] = f.map(i, j);
      }
      r.sign = f.cone ? -1.0 : 1.0;
      r.value = f(c);
      r.owner = index(f.owner);
      r.part = f.part;
    }
    for (int w = 0; w < 2; ++w) {
      const Segment& s = faces_.active.capsule[w];
      view_.seams[w] = {s.present, {s.axis.x(), s.axis.y(), s.axis.z()}, s.along(c), s.half_length};
    }
  }

  // The frame of the first look; true in a layer between two plane faces, which has one as flat as
  // this, and in a strip, which has one as thin. From the unit ball few chords would run along the
  // layer, perhaps one, and what they tell is far too flat across or along it.
  bool first_frame(const Vec3& c, Mat3& spread) const {
    for (const PlaneFace& one : faces_.active.planes) {
      if (one.owner != Owner::kA) continue;
      for (const PlaneFace& two : faces_.active.planes) {
        if (two.owner != Owner::kB || (one.normal + two.normal).norm() > kFlush) continue;
        const double height = one.offset - one.normal.dot(c) + two.offset - two.normal.dot(c);
        if (!(height > 0.0 && height < kFlush * size())) continue;
        spread = basis_with_z((one.normal - two.normal).normalized());
        spread.col(2) *= height / size();
        return true;
      }
    }
    const double length = strip_.norm(), depth = depth_of(c);
    if (depth > 0.0 && depth < kNearFace * length) {
      spread = basis_with_z(strip_ / length);
      spread.col(0) *= depth / length;
      spread.col(1) *= depth / length;
      return true;
    }
    spread = Mat3::Identity();
    return false;
  }

  // Whether an ellipsoid of these second moments is about a ball.
  static bool is_even(const Mat3& second, const Mat3& root) {
    const double mean = std::cbrt(root.diagonal().prod());
    return second.trace() < 3.0 * kEven * mean * mean;
  }

  // Chords from the point c in directions spread * axis, and what they tell of the overlap.
  void round_off(LinesWindow& window) {
    Vec3 c = window.center;
    Mat3 spread;
    const bool layer = first_frame(c, spread);
    for (int step = 0; step < (layer ? kMaxInLayer : kMaxRoundings); ++step) {
      ChordSums s;
      look_from(c);
      double m[9];
      for (int i = 0; i < 9; ++i) m[i] = spread(i / 3, i % 3);
      VOLCONTACT_SIMD_CALL(path_, chords, view_, m, step == 0, s);
      // In a very thin overlap what an ellipsoid was made of may be gone by rounding in the next
      // one.
      if (!(s.total > 0.0)) break;
      // A ball of radius r has the chord ends r: from them 3/4 r and 3/5 r^2 are the moments of the
      // solid between the center and the ends.
      const Vec3 shift = 0.75 / s.total * Vec3(s.first[0], s.first[1], s.first[2]);
      Mat3 second = {s.second[0], s.second[1], s.second[3], s.second[1], s.second[2],
                     s.second[4], s.second[3], s.second[4], s.second[5]};
      second = 3.0 / s.total * second - outer(5.0 * shift, shift);
      const double largest = second.diagonal().maxCoeff();
      if (!(largest > 0.0)) return;
      second += kThinnest * largest * Mat3::Identity();
      const double scale = 4.0 * kPi * std::abs(spread.determinant());
      window.volume = scale / 3.0 * s.cubes;
      window.area_vector = Vec3::Zero();
      for (int i = 0; i < 3; ++i) {
        window.area_vector[i] = 0.5 * scale * (s.surface[0][i] - s.surface[1][i]);
      }
      window.area = scale * (s.surface[0][3] + s.surface[1][3]);
      c = step_inside(c, spread * shift);
      const Mat3 root = cholesky(second);
      spread = spread * root;
      // No chord may come near the axis of a layer that is seen far too high, and none is long.
      const bool even = !layer || is_even(second, root);
      if (step > 0 && even && s.longest < kRound * s.shortest) break;
    }
    if (!(window.volume > 0.0) || !inside(c)) return;
    window.kind = LinesWindow::Kind::kOverlap;
    window.strip = layer && !strip_.isZero(0.0);
    window.center = c;
    window.spread = spread;
  }

  // As far towards c + step as stays inside.
  Vec3 step_inside(const Vec3& c, Vec3 step) const {
    for (int halving = 0; halving < 30; ++halving) {
      if (inside(c + step)) return c + step;
      step *= 0.5;
    }
    return c;
  }

  Solid2 solids_[2];
  Vec3 strip_ = Vec3::Zero();  // half of a strip that the start lies in
  SimdPath path_;
  LinesFaces& faces_;
  ChordFaces view_;
};

}  // namespace

LinesWindow find_lines_window(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                              SimdPath path, bool look_inside, LinesFaces& faces) {
  return WindowSearch(a, b, X_AB, path, faces).run(look_inside);
}

}  // namespace volcontact
