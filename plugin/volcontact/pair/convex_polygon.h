// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace volcontact {

/// a + b x + c y over a plane.
struct Linear2 {
  double a, b, c;
  double operator()(double x, double y) const { return a + b * x + c * y; }
  Linear2 raised(double height) const { return {a + height, b, c}; }
  Linear2 scaled(double factor) const { return {factor * a, factor * b, factor * c}; }
  Linear2 plus(const Linear2& other) const { return {a + other.a, b + other.b, c + other.c}; }
};

/// Convex polygon in a coordinate plane, cut by lines. Keeps its memory from one use to the next.
class ConvexPolygon {
 public:
  struct Point {
    double x, y;
  };

  /// Rectangle |x| <= half_x, |y| <= half_y.
  void start(double half_x, double half_y) {
    points_.assign({{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}});
  }
  const std::vector<Point>& points() const { return points_; }
  bool empty() const { return points_.size() < 3; }

  /// Keeps what has height <= 0.
  void cut(const Linear2& height) {
    if (!(highest(height) > 0.0)) return;
    kept_.clear();
    Point last = points_.back();
    double last_height = height(last.x, last.y);
    for (const Point& p : points_) {
      const double h = height(p.x, p.y);
      if ((h > 0.0) != (last_height > 0.0)) {
        const double t = last_height / (last_height - h);
        kept_.push_back({last.x + t * (p.x - last.x), last.y + t * (p.y - last.y)});
      }
      if (!(h > 0.0)) kept_.push_back(p);
      last = p;
      last_height = h;
    }
    points_.swap(kept_);
  }

  double highest(const Linear2& height) const {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Point& p : points_) highest = std::max(highest, height(p.x, p.y));
    return highest;
  }
  double area() const {
    double twice = 0.0;
    for (std::size_t i = 2; i < points_.size(); ++i) twice += twice_area(i);
    return 0.5 * twice;
  }

  /// Integral of f, exact for cubic f (four points a triangle: Strang and Fix, 1973).
  template <typename F>
  double integral(F&& f) const {
    double sum = 0.0;
    for (std::size_t i = 2; i < points_.size(); ++i) {
      const Point &p = points_[0], &q = points_[i - 1], &r = points_[i];
      const double x = p.x + q.x + r.x, y = p.y + q.y + r.y;
      double corners = 0.0;
      for (const Point* c : {&p, &q, &r}) corners += f(0.2 * x + 0.4 * c->x, 0.2 * y + 0.4 * c->y);
      sum += twice_area(i) * (25.0 / 96.0 * corners - 27.0 / 96.0 * f(x / 3.0, y / 3.0));
    }
    return sum;
  }

 private:
  double twice_area(std::size_t i) const {
    const Point &p = points_[0], &q = points_[i - 1], &r = points_[i];
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  }

  std::vector<Point> points_, kept_;
};

}  // namespace volcontact
