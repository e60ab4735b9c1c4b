// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_meshes.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/symmetric_eigen.h"
#include "volcontact/pair/pressure/triangles_near.h"
#include "volcontact/pair/quadrature/gauss.h"

namespace volcontact {
namespace {

constexpr double kForceTolerance = 2e-4;  // of the force, over V: where the division ends
constexpr int kMostDistances = 12000;     // of the division
constexpr double kFinest = 0.5;           // of the patch's smaller width: what no triangle may hide
constexpr int kMostColumnSteps = 8;       // of a search along a column
constexpr double kNearEnd = 1e-3;

bool a_carries(const Shape& a, const Shape& b, double share_of_a) {
  if (!std::holds_alternative<Mesh>(a)) return true;
  if (!std::holds_alternative<Mesh>(b)) return false;
  if (share_of_a != 0.5) return share_of_a > 0.5;
  return own_metrics_of(a).volume <= own_metrics_of(b).volume;
}

/// int d dA and int x d dA.
struct Push {
  double force = 0.0;
  Vec3 moment = Vec3::Zero();
  double square = 0.0;  ///< int d^2 dA

  Push& operator+=(const Push& other) {
    force += other.force, moment += other.moment, square += other.square;
    return *this;
  }
};

using Corner = PressureScratch::Corner;
using Leaf = PressureScratch::Leaf;

Corner between(const Corner& p, const Corner& q) {
  const double t = p.d / (p.d - q.d);
  return {p.x + t * (q.x - p.x), 0.0};
}

// Of a linear d over a triangle in which it is positive.
Push whole(const Corner& p, const Corner& q, const Corner& r) {
  const double area = 0.5 * (q.x - p.x).cross(r.x - p.x).norm(), sum = p.d + q.d + r.d;
  const Vec3 own = p.d * p.x + q.d * q.x + r.d * r.x;
  const double squares = p.d * p.d + q.d * q.d + r.d * r.d;
  return {area / 3.0 * sum, area / 12.0 * (sum * (p.x + q.x + r.x) + own),
          area / 12.0 * (sum * sum + squares)};
}

// Where it is positive.
Push positive(const Corner& p, const Corner& q, const Corner& r) {
  const int inside = (p.d > 0.0) + (q.d > 0.0) + (r.d > 0.0);
  if (inside == 0) return {};
  if (inside == 3) return whole(p, q, r);
  // Turned so that the first corner lies on its own side.
  const bool alone_in = inside == 1;
  const Corner* c[3] = {&p, &q, &r};
  int first = 0;
  while ((c[first]->d > 0.0) != alone_in) ++first;
  const Corner &one = *c[first], &two = *c[(first + 1) % 3], &three = *c[(first + 2) % 3];
  const Corner at_two = between(one, two), at_three = between(one, three);
  if (alone_in) return whole(one, at_two, at_three);
  Push push = whole(at_two, two, three);
  push += whole(at_two, three, at_three);
  return push;
}

// The quarters of a leaf.
constexpr int kParts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

Push on_part(const Leaf& leaf, int i) {
  return positive(leaf.corners[kParts[i][0]], leaf.corners[kParts[i][1]],
                  leaf.corners[kParts[i][2]]);
}

bool less_off(const Leaf& a, const Leaf& b) { return a.off < b.off; }

class MeshField {
 public:
  MeshField(const Shape& carrier, const Pose& X_AC, const Vec3& normal, const PressureSite& site,
            std::vector<Leaf>& leaves)
      : carrier_(carrier), X_AC_(X_AC), t_(normal), site_(site), leaves_(leaves) {
    leaves_.clear();
    finest_ = kInfinity;
    for (const VolumeMetrics& metrics : site.sites) {
      volume_ += metrics.volume;
      const Vec3 spread = symmetric_eigen(metrics.second_moment() / metrics.volume).values;
      finest_ = std::min(finest_, kFinest * std::sqrt(std::max(0.0, spread[1])));
    }
    reach_ = site.metrics().depth;
  }

  void add(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 twice = (q - p).cross(r - p);
    if (!(twice.norm() > 0.0)) return;
    n_ = twice.normalized();
    add_leaf(corner(p), corner(q), corner(r));
  }

  PressureField sum() {
    refine();
    for (const Leaf& leaf : leaves_) take(leaf);
    field_.error = std::max(0.0, all_off_);
    return field_;
  }

 private:
  double depth(const Vec3& x) {
    ++asked_;
    return -std::visit([&](const auto& solid) { return solid.signed_distance(x); }, carrier_);
  }
  Corner corner(const Vec3& x) { return {x, depth(x)}; }

  void add_leaf(const Corner& p, const Corner& q, const Corner& r) {
    const double longest = std::sqrt(std::max(
        {(q.x - p.x).squaredNorm(), (r.x - q.x).squaredNorm(), (p.x - r.x).squaredNorm()}));
    // The distance has the slope 1, and no point is farther than this from the nearest corner.
    if (std::max({p.d, q.d, r.d}) <= -longest / std::sqrt(3.0)) return;
    const Leaf leaf{
        {p, q, r, corner(0.5 * (p.x + q.x)), corner(0.5 * (q.x + r.x)), corner(0.5 * (r.x + p.x))},
        n_,
        0.0};
    const Push one = positive(p, q, r);
    double four = 0.0;
    for (int i = 0; i < 4; ++i) four += on_part(leaf, i).force;
    // What may hide in it is looked for first.
    const double off = longest > finest_ ? kInfinity : std::abs(four - one.force);
    leaves_.push_back(leaf);
    leaves_.back().off = off;
    std::push_heap(leaves_.begin(), leaves_.end(), less_off);
    if (off < kInfinity) all_off_ += off;
  }

  // The leaf that is off the most, into its quarters, until all together are not off by much.
  void refine() {
    while (!leaves_.empty() && asked_ < kMostDistances) {
      const double most = leaves_.front().off;
      if (most < kInfinity && all_off_ <= kForceTolerance * volume_) break;
      std::pop_heap(leaves_.begin(), leaves_.end(), less_off);
      const Leaf leaf = leaves_.back();
      leaves_.pop_back();
      if (most < kInfinity) all_off_ -= most;
      n_ = leaf.n;
      for (const auto& part : kParts) {
        add_leaf(leaf.corners[part[0]], leaf.corners[part[1]], leaf.corners[part[2]]);
      }
    }
  }

  void take(const Leaf& leaf) {
    const double across = leaf.n.dot(t_);
    for (int i = 0; i < 4; ++i) {
      const Push push = on_part(leaf, i);
      if (!(push.force > 0.0)) continue;
      const Vec3 place = push.moment / push.force;
      if (site_.sites.size() > 1 && site_.nearest(X_AC_ * place) != site_.index) continue;
      field_.force += push.force * leaf.n;
      field_.couple += push.moment.cross(leaf.n);
      if (across != 0.0) field_.energy += across * push.square * column_over_square(place);
    }
  }

  // int d along the column from x down to where it leaves the carrier, over d^2 at x.
  double column_over_square(const Vec3& x) {
    const double top = depth(x);
    if (!(top > 0.0)) return 0.0;
    double end = top, before = 0.0, at_before = top;
    for (int step = 0; step < kMostColumnSteps && end < reach_; ++step) {
      const double at_end = depth(x - end * t_);
      if (at_end <= kNearEnd * top) break;
      const double secant = at_end < at_before ? at_end * (end - before) / (at_before - at_end) : 0;
      before = end, at_before = at_end;
      end += std::max(at_end, secant);
    }
    end = std::min(end, std::max(reach_, top));
    using Rule = GaussRule<5>;
    double sum = 0.0;
    for (int i = 0; i < 5; ++i) {
      sum += Rule::kWeights[i] * std::max(0.0, depth(x - Rule::kNodes[i] * end * t_));
    }
    return sum * end / (top * top);
  }

  const Shape& carrier_;
  const Pose& X_AC_;
  Vec3 t_;  // out of the rigid one
  const PressureSite& site_;
  double volume_ = 0.0, finest_ = 0.0, reach_ = 0.0;
  int asked_ = 0;
  Vec3 n_;  // of the triangle at hand
  std::vector<Leaf>& leaves_;
  double all_off_ = 0.0;
  PressureField field_;
};

}  // namespace

PressureField pressure_meshes(const Shape& a, const Shape& b, const Pose& X_AB,
                              const PressureSite& site, PressureScratch& scratch) {
  const bool is_a = a_carries(a, b, site.share_of_a);
  const Shape& carrier = is_a ? a : b;
  const Pose X_CR = is_a ? X_AB : X_AB.inverse(), X_AC = is_a ? Pose{} : X_AB;
  const Vec3 normal = (is_a ? 1.0 : -1.0) * site.metrics().normal();
  MeshField field(carrier, X_AC, X_AC.rotation.transpose() * normal, site, scratch.leaves);
  const Aabb bounds = bounds_of(carrier);
  const auto outside = [&](const Vec3& x) {
    const Vec3 beyond = (x - bounds.center()).cwiseAbs() - bounds.half_sizes();
    return beyond.cwiseMax(0.0).norm();
  };
  visit_triangles_near(std::get<Mesh>(is_a ? b : a), X_CR, scratch.stack, outside,
                       [&](const Vec3& p, const Vec3& q, const Vec3& r) { field.add(p, q, r); });
  return field_on_a(field.sum(), X_AC, is_a, site.metrics().centroid);
}

}  // namespace volcontact
