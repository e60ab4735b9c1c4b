// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>
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

  ConvexPolygon() : points_(kUsual), kept_(kUsual), heights_(kUsual) {}
  ConvexPolygon(const ConvexPolygon& other) : ConvexPolygon() { *this = other; }
  ConvexPolygon& operator=(const ConvexPolygon& other) {
    reserve(points_, other.count_);
    count_ = other.count_;
    std::copy_n(other.points_.data(), count_, points_.data());
    return *this;
  }

  /// Rectangle |x| <= half_x, |y| <= half_y.
  void start(double half_x, double half_y) {
    points_[0] = {-half_x, -half_y};
    points_[1] = {half_x, -half_y};
    points_[2] = {half_x, half_y};
    points_[3] = {-half_x, half_y};
    count_ = 4;
  }
  std::span<const Point> points() const { return {points_.data(), count_}; }
  bool empty() const { return count_ < 3; }
  /// Mean of its corners.
  Point middle() const {
    Point sum{0.0, 0.0};
    for (const Point& p : points()) sum = {sum.x + p.x, sum.y + p.y};
    const auto count = static_cast<double>(count_);
    return {sum.x / count, sum.y / count};
  }

  /// Keeps what has height <= 0.
  void cut(const Linear2& height) {
    reserve(heights_, count_);
    bool crossed = false;
    for (std::size_t i = 0; i < count_; ++i) {
      heights_[i] = height(points_[i].x, points_[i].y);
      crossed |= heights_[i] > 0.0;
    }
    if (!crossed) return;
    reserve(kept_, 2 * count_ + 1);  // as many as rounding may make, and one that does not stay
    Point* kept = kept_.data();
    Point last = points_[count_ - 1];
    double last_height = heights_[count_ - 1];
    for (std::size_t i = 0; i < count_; ++i) {
      const Point p = points_[i];
      const double h = heights_[i];
      const double t = last_height / (last_height - h);  // of use where the line is crossed
      *kept = {last.x + t * (p.x - last.x), last.y + t * (p.y - last.y)};
      kept += (h > 0.0) != (last_height > 0.0);
      *kept = p;
      kept += !(h > 0.0);
      last = p;
      last_height = h;
    }
    count_ = kept - kept_.data();
    points_.swap(kept_);
  }

  double highest(const Linear2& height) const {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Point& p : points()) highest = std::max(highest, height(p.x, p.y));
    return highest;
  }
  double area() const {
    double twice = 0.0;
    for (std::size_t i = 2; i < count_; ++i) twice += twice_area(i);
    return 0.5 * twice;
  }

  /// Integral of f, exact for cubic f (four points a triangle: Strang and Fix, 1973).
  template <typename F>
  double integral(F&& f) const {
    double sum = 0.0;
    for (std::size_t i = 2; i < count_; ++i) {
      const Point &p = points_[0], &q = points_[i - 1], &r = points_[i];
      const double x = p.x + q.x + r.x, y = p.y + q.y + r.y;
      double corners = 0.0;
      for (const Point* c : {&p, &q, &r}) corners += f(0.2 * x + 0.4 * c->x, 0.2 * y + 0.4 * c->y);
      sum += twice_area(i) * (25.0 / 96.0 * corners - 27.0 / 96.0 * f(x / 3.0, y / 3.0));
    }
    return sum;
  }

 private:
  static constexpr std::size_t kUsual = 64;  // memory that is enough but for many more faces

  template <typename T>
  static void reserve(std::vector<T>& memory, std::size_t count) {
    if (memory.size() < count) memory.resize(2 * count);
  }

  double twice_area(std::size_t i) const {
    const Point &p = points_[0], &q = points_[i - 1], &r = points_[i];
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  }

  std::size_t count_ = 0;
  std::vector<Point> points_, kept_;  // grown, never shrunk
  std::vector<double> heights_;
};

}  // namespace volcontact
