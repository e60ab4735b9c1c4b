// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/radial_cut.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr double kPlain = 0.25;     // bend of the level along an edge, of its values there
constexpr double kNoBend = 1e-9;    // of the wall's size
constexpr int kMostDivisions = 60;  // of a triangle in two
constexpr double kSmall = 0.2;      // of a tube's radius: so small where it is cut at a slant
constexpr double kNearTube = 0.7;   // of a tube's radius: a longer edge may pass through it unseen
constexpr double kNearPole = 0.5;   // of the distance to a pole: a larger triangle is divided
constexpr double kAtPole = 1e-4;    // of a tube's radius: so small ones are not
constexpr int kMostSteps = 20;      // to a root
constexpr double kRootPrecision = 1e-8;  // of the edge; the error of the step after is its square
constexpr double kNearEnd = 0.1;         // of an edge, as a place to divide it at
constexpr int kSagSteps = 2;             // of Newton, from the chord to the arc

struct Edges {
  Vec3 middle[3];   // of the edge from corner i to the next
  double level[3];  // there
  double bend[3];   // of the level along the edge
  double length[3];
};

Edges edges_of(const RadialWall& wall, const Vec3 (&c)[3], const double (&level)[3]) {
  Edges e;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    e.middle[i] = 0.5 * (c[i] + c[j]);
    e.level[i] = wall.level(e.middle[i]);
    e.bend[i] = std::abs(e.level[i] - 0.5 * (level[i] + level[j]));
    e.length[i] = (c[j] - c[i]).norm();
  }
  return e;
}

// The edge that is worst to keep; by its length where the wall is a plane.
int worst_edge(const Edges& e) {
  int worst = 0;
  const auto badness = [&](int i) { return e.bend[i] + 1e-6 * e.length[i]; };
  for (int i = 1; i < 3; ++i) {
    if (badness(i) > badness(worst)) worst = i;
  }
  return worst;
}

int longest_edge(const Edges& e) {
  return static_cast<int>(std::max_element(e.length, e.length + 3) - e.length);
}

enum class Place {
  kOutside,
  kInside,
  kCut,
  kLarge,    // too large to tell
  kGrazing,  // the same beside a face along the wall of a torus
  kBent      // the wall bends too much along some edge
};

// How far the level of a torus may be off its tangent plane at x, at most, anywhere nearer than
// `reach`.
double off_tangent(const RadialWall& wall, const Vec3& x, double reach) {
  const double r = RadialWall::length(x.x(), x.y()), least_r = r - reach;
  const double least = RadialWall::length(r - wall.major, x.z()) - reach;
  if (!(least > 0.0 && least_r > 0.0)) return kInfinity;
  // 1 / distance from the circle around the tube, cos / distance from the axis around that.
  const double cosine = std::min(1.0, (std::abs(r - wall.major) + reach) / least);
  return 0.5 * reach * reach * std::max(1.0 / least, cosine / least_r);
}

// The same in a triangle about x, far less in one along a circle of the torus. The level is the
// distance d from (major, 0) of (r, z), and r, the distance from the axis, is convex:
//   (r, z) moves by (dr, dz) at most, of which d is off its tangent by (dr^2 + dz^2) / 2 d,
//   and r is off its own by (x' - x)^2 / 2 r, of which d has the share (r - major) / d.
double off_tangent(const RadialWall& wall, const Vec3& x, const Vec3 (&c)[3], double reach) {
  const double r = RadialWall::length(x.x(), x.y()), least_r = r - reach;
  if (!(least_r > 0.0)) return kInfinity;
  double out = 0.0, in = 0.0, up = 0.0, down = 0.0;
  for (const Vec3& p : c) {
    out = std::max(out, RadialWall::length(p.x(), p.y()) - r);
    in = std::max(in, r - (x.x() * p.x() + x.y() * p.y()) / r);
    up = std::max(up, p.z() - x.z());
    down = std::max(down, x.z() - p.z());
  }
  const double across = std::max({0.0, r - in - wall.major, wall.major - r - out});
  const double along = std::max({0.0, x.z() - down, -x.z() - up});
  const double least = RadialWall::length(across, along);
  if (!(least > 0.0)) return kInfinity;
  const double dr = std::max(in, out), dz = std::max(up, down);
  const double share = std::abs(r - wall.major) / RadialWall::length(r - wall.major, x.z());
  return 0.5 * ((dr * dr + dz * dz) / least + share * reach * reach / least_r);
}

// The edge along which the level of a torus bends most, as above; those along its circles do so
// least.
int most_bent_edge(const RadialWall& wall, const Vec3 (&c)[3], const Edges& e) {
  int most = 0;
  double bend[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3 &p = c[i], &q = c[i == 2 ? 0 : i + 1], &m = e.middle[i];
    const double r = RadialWall::length(m.x(), m.y()), off_tube = std::abs(r - wall.major);
    const double bend_of_r = e.length[i] * e.length[i] / r;
    const double change_of_r =
        std::abs(RadialWall::length(p.x(), p.y()) - RadialWall::length(q.x(), q.y()));
    const double dr = change_of_r + 0.125 * bend_of_r, dz = p.z() - q.z();
    bend[i] = (dr * dr + dz * dz + off_tube * bend_of_r) / RadialWall::length(off_tube, m.z());
    if (bend[i] > bend[most]) most = i;
  }
  return most;
}

// Whether the parabola through three values at 0, 1/2 and 1, the outer ones of one sign, has the
// other sign somewhere between.
bool changes_between(double at_0, double at_half, double at_1) {
  if ((at_half < 0.0) != (at_0 < 0.0)) return true;
  const double bend = at_0 + at_1 - 2.0 * at_half, slope = at_1 - at_0;
  if (std::abs(slope) >= 4.0 * std::abs(bend) || bend == 0.0) return false;
  return (at_half - slope * slope / (8.0 * bend) < 0.0) != (at_0 < 0.0);
}

Place place_of(const RadialWall& wall, const Vec3 (&c)[3], const double (&level)[3],
               const Edges& e) {
  const double most = std::max({level[0], level[1], level[2]});
  const double least = std::min({level[0], level[1], level[2]});
  const double size = wall.radius + wall.major + std::abs(wall.slope * c[0].z());
  const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
  const double in_middle = wall.level(middle);
  const Vec3 slope = wall.gradient(middle);
  double reach = 0.0, over = -kInfinity, below = kInfinity;
  for (const Vec3& p : c) {
    const double tangent = in_middle + slope.dot(p - middle);
    reach = std::max(reach, (p - middle).norm());
    over = std::max(over, tangent);
    below = std::min(below, tangent);
  }
  if (wall.torus) {
    if (in_middle > reach) return Place::kOutside;
    if (in_middle < -reach) return Place::kInside;
    const bool grazing = reach < kSmall * wall.radius;
    const double off =
        grazing ? off_tangent(wall, middle, c, reach) : off_tangent(wall, middle, reach);
    if (below - off > -kNoBend * size) return Place::kOutside;
    if (over + off < kNoBend * size) return Place::kInside;
    if (reach > kNearTube * wall.radius) return Place::kLarge;
    if (off > most - least || most < 0.0 || least >= 0.0) {
      return grazing ? Place::kGrazing : Place::kLarge;
    }
  } else {
    // The level of a bore is concave: nowhere below its corners, nowhere over its tangent.
    if (least >= 0.0) return Place::kOutside;
    if (over <= 0.0) return Place::kInside;
  }
  if (most < 0.0 || least >= 0.0) return Place::kBent;
  const double bend = std::max({e.bend[0], e.bend[1], e.bend[2]});
  if (bend <= kNoBend * size) return Place::kCut;
  if (bend > kPlain * (most - least)) return Place::kBent;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    if ((level[i] < 0.0) != (level[j] < 0.0)) continue;
    if (changes_between(level[i], e.level[i], level[j])) return Place::kBent;
  }
  return Place::kCut;
}

// Whether a triangle is large beside its distance from the circle in the middle of a torus: what is
// integrated over it has a pole there.
bool is_at_circle(const RadialWall& wall, const Vec3 (&c)[3]) {
  if (!wall.torus) return false;
  const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
  double reach = 0.0;
  for (const Vec3& p : c) reach = std::max(reach, (p - middle).norm());
  return reach > kAtPole * wall.radius && reach > kNearPole * (wall.level(middle) + wall.radius);
}

// Where the level vanishes between p and q, where it has different signs.
Vec3 root_between(const RadialWall& wall, const Vec3& p, double at_p, const Vec3& q, double at_q) {
  const Vec3 way = q - p;
  double low = 0.0, high = 1.0, t = at_p / (at_p - at_q);
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec3 x = p + t * way;
    const double f = wall.level(x), slope = wall.gradient(x).dot(way);
    if ((f < 0.0) == (at_p < 0.0)) {
      low = t;
    } else {
      high = t;
    }
    const double next = t - f / slope;
    const bool within = next > low && next < high;
    const double moved = std::abs(next - t);
    t = within ? next : 0.5 * (low + high);
    if (within && moved < kRootPrecision) break;
  }
  return p + t * way;
}

// About where the level is lowest between p and q, or half way where it only rises or is lowest
// near an end: edges from there to others of the kind run along the wall.
Vec3 lowest_between(const RadialWall& wall, const Vec3& p, const Vec3& q) {
  const Vec3 way = q - p;
  const double at_p = wall.gradient(p).dot(way), at_q = wall.gradient(q).dot(way);
  const double t = at_p / (at_p - at_q);
  return p + (at_p < 0.0 && at_q > 0.0 && t > kNearEnd && t < 1.0 - kNearEnd ? t : 0.5) * way;
}

// A triangle with corners on both sides of the wall.
RadialPart cut_part(const RadialWall& wall, const Vec3 (&c)[3], const double (&level)[3],
                    int face) {
  int alone = 0;
  for (int i = 0; i < 3; ++i) {
    const bool in = level[i] < 0.0;
    if (in != (level[(i + 1) % 3] < 0.0) && in != (level[(i + 2) % 3] < 0.0)) alone = i;
  }
  const int j = (alone + 1) % 3, k = (alone + 2) % 3;
  RadialPart part{{c[alone], c[j], c[k]}, face, false, level[alone] < 0.0, {}};
  const auto root = [&](int other) {
    return root_between(wall, c[alone], level[alone], c[other], level[other]);
  };
  part.chord[0] = root(j);
  part.chord[1] = root(k);
  const Vec3 chord = part.chord[1] - part.chord[0];
  const Vec3 middle = 0.5 * (part.chord[0] + part.chord[1]);
  const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const Vec3 out = (part.alone_in ? chord.cross(normal) : normal.cross(chord)).stableNormalized();
  const double length = chord.norm();
  for (int step = 0; step < kSagSteps; ++step) {
    const Vec3 x = middle + part.sag * out;
    const double steepness = wall.gradient(x).dot(out);
    if (!(steepness > 0.0)) break;
    part.sag = std::clamp(part.sag - wall.level(x) / steepness, -length, length);
  }
  return part;
}

}  // namespace

bool divide_at_wall(const RadialWall& wall, const Vec3 (&c)[3], int face, int divisions,
                    int most_parts, std::vector<RadialPart>& parts) {
  const double level[3] = {wall.level(c[0]), wall.level(c[1]), wall.level(c[2])};
  const Edges e = edges_of(wall, c, level);
  Place place = place_of(wall, c, level, e);
  if (place == Place::kInside && divisions < kMostDivisions && is_at_circle(wall, c)) {
    place = Place::kLarge;
  }
  switch (place) {
    case Place::kOutside:
      return true;
    case Place::kInside:
      parts.push_back({{c[0], c[1], c[2]}, face, true, false, {}});
      return true;
    case Place::kCut:
      parts.push_back(cut_part(wall, c, level, face));
      return true;
    case Place::kLarge:
    case Place::kGrazing:
    case Place::kBent:
      break;
  }
  if (divisions >= kMostDivisions || static_cast<int>(parts.size()) > most_parts) return false;
  const int i = place == Place::kBent      ? worst_edge(e)
                : place == Place::kGrazing ? most_bent_edge(wall, c, e)
                                           : longest_edge(e);
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const Vec3 at = place == Place::kGrazing ? lowest_between(wall, c[i], c[j]) : e.middle[i];
  const Vec3 one[3] = {c[i], at, c[k]}, two[3] = {at, c[j], c[k]};
  return divide_at_wall(wall, one, face, divisions + 1, most_parts, parts) &&
         divide_at_wall(wall, two, face, divisions + 1, most_parts, parts);
}

int edge_to_divide(const RadialWall& wall, const RadialPart& part) {
  const double level[3] = {wall.level(part.corner[0]), wall.level(part.corner[1]),
                           wall.level(part.corner[2])};
  return worst_edge(edges_of(wall, part.corner, level));
}

void add_pieces(const RadialPart& part, int number, RadialPieces& pieces) {
  const Vec3(&c)[3] = part.corner;
  if (part.inside) return pieces.add_triangle(c[0], c[1], c[2], number);
  const Vec3 &p = part.chord[0], &q = part.chord[1];
  if (part.alone_in) {
    pieces.add_triangle(c[0], p, q, number);
  } else {
    pieces.add_triangle(p, c[1], c[2], number);
    pieces.add_triangle(p, c[2], q, number);
  }
  const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]).stableNormalized();
  pieces.add_sliver(0.5 * (p + q), normal, 2.0 / 3.0 * (q - p).norm() * part.sag, number);
}

}  // namespace volcontact
