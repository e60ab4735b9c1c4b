// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/obb_tree.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "volcontact/base/fields.h"

namespace volcontact {
namespace {

constexpr double kPadding = 1e-13;  // of the size of the mesh
constexpr double kSlender = 16.0;   // a box longer than this is cut across
constexpr double kThinner = 1.7;    // how much volume a cut along the box must save

struct Obb {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  // rows
  Vec3 half = Vec3::Zero();

  double area() const { return half.x() * half.y() + half.y() * half.z() + half.z() * half.x(); }
};

// Binary tree over ranges of `order`, from which the wide one is gathered.
struct Branch {
  Obb box;
  int first, last;
  int left = -1;  // the right one follows it; -1 = leaf
};

class Builder {
 public:
  explicit Builder(const MeshTopology& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    for (const Triangle& t : mesh.triangles) {
      middles_.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
    }
    Vec3 low = mesh.vertices[0], high = mesh.vertices[0];
    for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
    padding_ = kPadding * (low.cwiseAbs().cwiseMax(high.cwiseAbs())).sum();
  }

  ObbTree build() {
    const int count = static_cast<int>(order_.size());
    branches_.push_back({fit(0, count), 0, count});
    split(0);
    gather(0);
    fill_twins();
    return std::move(tree_);
  }

 private:
  Obb fit(int first, int last) const {
    Mat3 second = Mat3::Zero();
    Vec3 mean = Vec3::Zero();
    double weight = 0.0;
    for (int i = first; i < last; ++i) {
      const Triangle& t = mesh_.triangles[order_[i]];
      const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
      const double area = (b - a).cross(c - a).norm();
      const Vec3 sum = a + b + c;
      weight += area;
      mean += area / 3.0 * sum;
      second += area / 12.0 *
                (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
    }
    Obb upright = around(Mat3::Identity(), first, last);
    if (!(weight > 0.0)) return upright;
    mean /= weight;
    const Mat3 covariance = second / weight - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
    const Obb turned = around(solver.eigenvectors().transpose(), first, last);
    return upright.half.prod() < 0.9 * turned.half.prod() ? upright : turned;
  }

  Obb around(const Mat3& axes, int first, int last) const {
    Vec3 low = Vec3::Constant(kInfinity), high = -low;
    for (int i = first; i < last; ++i) {
      for (int corner : mesh_.triangles[order_[i]]) {
        const Vec3 p = axes * mesh_.vertices[corner];
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    return {axes.transpose() * (0.5 * (low + high)), axes,
            0.5 * (high - low) + Vec3::Constant(padding_)};
  }

  // Sorts a range of triangles into two halves along a direction; returns where the second begins.
  int halve(int first, int last, const Vec3& along) {
    const int leaves = (last - first + kLanes - 1) / kLanes;
    const int middle = first + (leaves + 1) / 2 * kLanes;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](int i, int j) {
                       const double a = along.dot(middles_[i]), b = along.dot(middles_[j]);
                       return a != b ? a < b : i < j;
                     });
    return middle;
  }

  // Across the longest side of its box, or across the second longest where that makes the boxes
  // much thinner, as around a cylinder.
  void split(int index) {
    const int first = branches_[index].first, last = branches_[index].last;
    if (last - first <= kLanes) return;
    const Obb box = branches_[index].box;
    int sides[3] = {0, 1, 2};
    std::sort(sides, sides + 3, [&](int i, int j) { return box.half[i] > box.half[j]; });
    Obb halves[2];
    int middle = 0;
    double least = kInfinity;
    for (int k = 1; k >= 0; --k) {
      if (k == 1 && box.half[sides[0]] > kSlender * box.half[sides[1]]) continue;
      const int at = halve(first, last, box.axes.row(sides[k]).transpose());
      const Obb left = fit(first, at), right = fit(at, last);
      const double volume = left.half.prod() + right.half.prod();
      if (k == 0 && volume > kThinner * least) {
        halve(first, last, box.axes.row(sides[1]).transpose());
        break;
      }
      halves[0] = left, halves[1] = right;
      middle = at;
      least = volume;
    }
    const int left = static_cast<int>(branches_.size());
    branches_[index].left = left;
    branches_.push_back({halves[0], first, middle});
    branches_.push_back({halves[1], middle, last});
    split(left);
    split(left + 1);
  }

  int add_leaf(const Branch& branch) {
    ObbTree::Leaf leaf;
    leaf.count = branch.last - branch.first;
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool used = lane < leaf.count;
      const int t = order_[branch.first + (used ? lane : 0)];
      tree_.triangle_of_slot.push_back(used ? t : -1);
      for (int i = 0; i < 3; ++i) {
        const Vec3& p = mesh_.vertices[mesh_.triangles[t][used ? i : 0]];
        for (int k = 0; k < 3; ++k) leaf.corner[i][k][lane] = p[k];
      }
    }
    tree_.leaves.push_back(leaf);
    return static_cast<int>(tree_.leaves.size()) - 1;
  }

  // The node whose lanes are the largest boxes below a branch.
  int gather(int index) {
    const int number = static_cast<int>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    std::vector<int> lanes;
    if (branches_[index].left < 0) {
      lanes.push_back(index);
    } else {
      lanes = {branches_[index].left, branches_[index].left + 1};
    }
    while (lanes.size() < kLanes) {
      int best = -1;
      for (std::size_t i = 0; i < lanes.size(); ++i) {
        const Branch& branch = branches_[lanes[i]];
        if (branch.left < 0) continue;
        if (best < 0 || branch.box.area() > branches_[lanes[best]].box.area()) {
          best = static_cast<int>(i);
        }
      }
      if (best < 0) break;
      const int left = branches_[lanes[best]].left;
      lanes[best] = left;
      lanes.push_back(left + 1);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool used = lane < static_cast<int>(lanes.size());
      const Obb& box = branches_[lanes[used ? lane : 0]].box;
      ObbTree::Node& node = tree_.nodes[number];
      int thinnest;
      box.half.minCoeff(&thinnest);
      for (int k = 0; k < 3; ++k) {
        const int from = k == ObbTree::kFlatAxis ? thinnest
                         : k == thinnest         ? ObbTree::kFlatAxis
                                                 : k;
        node.center[k][lane] = box.center[k];
        node.half[k][lane] = box.half[from];
        for (int j = 0; j < 3; ++j) node.axis[k][j][lane] = box.axes(from, j);
      }
      node.child[lane] = -1;
    }
    tree_.nodes[number].count = static_cast<int>(lanes.size());
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      const Branch& branch = branches_[lanes[lane]];
      const int child = branch.left < 0 ? ~add_leaf(branch) : gather(lanes[lane]);
      tree_.nodes[number].child[lane] = child;
    }
    return number;
  }

  void fill_twins() {
    std::vector<int> slot_of(mesh_.triangles.size());
    const int slots = static_cast<int>(tree_.triangle_of_slot.size());
    for (int s = 0; s < slots; ++s) {
      if (tree_.triangle_of_slot[s] >= 0) slot_of[tree_.triangle_of_slot[s]] = s;
    }
    tree_.twins.assign(3 * slots, -1);
    for (int s = 0; s < slots; ++s) {
      const int t = tree_.triangle_of_slot[s];
      for (int i = 0; t >= 0 && i < 3; ++i) {
        const int twin = mesh_.twins[3 * t + i];
        tree_.twins[3 * s + i] = 3 * slot_of[twin / 3] + twin % 3;
      }
    }
  }

  const MeshTopology& mesh_;
  std::vector<int> order_;
  std::vector<Vec3> middles_;
  double padding_;
  std::vector<Branch> branches_;
  ObbTree tree_;
};

}  // namespace

ObbTree make_obb_tree(const MeshTopology& topology) { return Builder(topology).build(); }

}  // namespace volcontact
