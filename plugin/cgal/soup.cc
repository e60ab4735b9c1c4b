// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/soup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace volcontact_cgal {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool near(const Point& a, const Point& b, double tolerance) {
  return std::abs(a[0] - b[0]) <= tolerance && std::abs(a[1] - b[1]) <= tolerance &&
         std::abs(a[2] - b[2]) <= tolerance;
}

/// For each point the index of the one it is welded to, which may be itself: sweep along x.
std::vector<std::size_t> weld_targets(const std::vector<Point>& points, double tolerance) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  std::vector<std::size_t> target(points.size(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (target[order[i]] != kNone) continue;
    target[order[i]] = order[i];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Point& other = points[order[j]];
      if (other[0] - points[order[i]][0] > tolerance) break;
      // Equal points stand side by side in the order; looking further costs the square of it.
      if (tolerance == 0.0 && other != points[order[i]]) break;
      if (target[order[j]] == kNone && near(points[order[i]], other, tolerance)) {
        target[order[j]] = order[i];
      }
    }
  }
  return target;
}

/// Faces of the same three corners: those turned one way less those turned the other.
struct Same {
  int net = 0;
  std::size_t first_even = kNone;
  std::size_t first_odd = kNone;
};

/// Whether an even number of swaps sorts the corners.
bool is_even(const Face& f) { return ((f[0] < f[1]) + (f[1] < f[2]) + (f[2] < f[0])) == 2; }

void keep_used_points(Soup& soup) {
  std::vector<std::size_t> new_index(soup.points.size(), kNone);
  std::vector<Point> used;
  for (Face& face : soup.faces) {
    for (std::size_t& corner : face) {
      if (new_index[corner] == kNone) {
        new_index[corner] = used.size();
        used.push_back(soup.points[corner]);
      }
      corner = new_index[corner];
    }
  }
  soup.points = std::move(used);
}

}  // namespace

Cleaning clean(Soup& soup, double tolerance) {
  Cleaning done;
  const std::vector<std::size_t> target = weld_targets(soup.points, tolerance);
  for (std::size_t i = 0; i < target.size(); ++i) done.points_welded += target[i] != i;

  std::map<Face, Same> seen;
  for (std::size_t i = 0; i < soup.faces.size(); ++i) {
    Face& face = soup.faces[i];
    for (std::size_t& corner : face) corner = target[corner];
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
      ++done.faces_folded;
      continue;
    }
    const bool even = is_even(face);
    Face corners = face;
    std::sort(corners.begin(), corners.end());
    Same& same = seen[corners];
    same.net += even ? 1 : -1;
    std::size_t& first = even ? same.first_even : same.first_odd;
    if (first == kNone) first = i;
    ++done.faces_twice;
  }
  for (const auto& [corners, same] : seen) {
    if (same.net != 0) done.kept.push_back(same.net > 0 ? same.first_even : same.first_odd);
  }
  std::sort(done.kept.begin(), done.kept.end());
  done.faces_twice -= done.kept.size();
  std::vector<Face> faces;
  for (const std::size_t i : done.kept) faces.push_back(soup.faces[i]);
  soup.faces = std::move(faces);
  keep_used_points(soup);
  return done;
}

}  // namespace volcontact_cgal
