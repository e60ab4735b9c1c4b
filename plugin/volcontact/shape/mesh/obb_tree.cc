// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/mesh/obb_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "volcontact/base/fields.h"
#include "volcontact/base/symmetric_eigen.h"

namespace volcontact {
namespace {

constexpr double kPadding = 1e-13;    // of the size of the mesh
constexpr double kBoxPadding = 5e-7;  // of the size of the mesh: boxes are kept in floats
constexpr double kFlat = 0.005;       // thickness of a flat box by its length
constexpr double kOther = 0.9;        // volume to be left, by that of a cut across the longest side
constexpr int kSamples = 256;         // triangles by which ways to part many are compared
constexpr int kLeastGap = 4;          // between normals on both sides of an edge, in eighths
constexpr double kSaved = 0.8;        // volume to be left by a cut that was worth it

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

class TreeBuilder {
 public:
  explicit TreeBuilder(const MeshTopology& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      middles_.push_back((a + b + c) / 3.0);
      normals_.push_back((b - a).cross(c - a).stableNormalized());
    }
    Vec3 low = mesh.vertices[0], high = mesh.vertices[0];
    for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
    tree_.size = low.cwiseAbs().cwiseMax(high.cwiseAbs()).sum();
    padding_ = kPadding * tree_.size;
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
  // Around all triangles of a range, or around every so many of them.
  Obb fit(int first, int last, int stride = 1) const {
    Mat3 second = Mat3::Zero();
    Vec3 mean = Vec3::Zero();
    double weight = 0.0;
    for (int i = first; i < last; i += stride) {
      const Triangle& t = mesh_.triangles[order_[i]];
      const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
      const double area = (b - a).cross(c - a).norm();
      const Vec3 sum = a + b + c;
      weight += area;
      mean += area / 3.0 * sum;
      second += area / 12.0 * (outer(sum, sum) + outer(a, a) + outer(b, b) + outer(c, c));
    }
    Obb upright = around(Mat3::Identity(), first, last, stride);
    if (!(weight > 0.0)) return upright;
    mean /= weight;
    const Mat3 covariance = second / weight - outer(mean, mean);
    const Mat3 axes = symmetric_eigen(covariance).vectors;
    const Obb turned = around(axes.transpose(), first, last, stride);
    return upright.half.prod() < 0.9 * turned.half.prod() ? upright : turned;
  }

  Obb around(const Mat3& axes, int first, int last, int stride) const {
    Vec3 low = Vec3::Constant(kInfinity), high = -low;
    for (int i = first; i < last; i += stride) {
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

  // Ways to part the triangles of a branch: in halves across a side of its box, or by the
  // directions they look in.
  static constexpr int kByNormals = 3;
  struct Ways {
    int list[4], count;  // the cut across the longest side first
  };
  static Ways ways_of(const Obb& box) {
    Ways ways{{0, 1, 2, kByNormals}, 4};
    std::sort(ways.list, ways.list + 3, [&](int i, int j) { return box.half[i] > box.half[j]; });
    if (box.half[ways.list[2]] < kFlat * box.half[ways.list[0]]) ways.count = 1;
    return ways;
  }

  // Returns where the second part begins; the end of the branch when there is none.
  int part(const Branch& branch, int way) {
    if (way == kByNormals) return part_by_normals(branch);
    return halve(branch.first, branch.last, branch.box.axes.row(way));
  }

  // Where no triangle looks in between: on both sides of a sharp edge.
  int part_by_normals(const Branch& branch) {
    constexpr int kBins = 16;
    const auto bin_of = [](double cosine) {
      return std::clamp(static_cast<int>((0.5 + 0.5 * cosine) * kBins), 0, kBins - 1);
    };
    int widest = kLeastGap - 1, side = -1, limit = 0;
    for (int k = 0; k < 3; ++k) {
      bool taken[kBins] = {};
      for (int i = branch.first; i < branch.last; ++i) {
        taken[bin_of(branch.box.axes.row(k).dot(normals_[order_[i]]))] = true;
      }
      for (int bin = 0, last = -1; bin < kBins; ++bin) {
        if (!taken[bin]) continue;
        if (last >= 0 && bin - last > widest) widest = bin - last, side = k, limit = bin;
        last = bin;
      }
    }
    if (side < 0) return branch.last;
    const auto second = std::stable_partition(
        order_.begin() + branch.first, order_.begin() + branch.last,
        [&](int i) { return bin_of(branch.box.axes.row(side).dot(normals_[i])) < limit; });
    return static_cast<int>(second - order_.begin());
  }

  Branch sampled(int first, int last) const {
    return {fit(first, last, std::max(1, (last - first) / kSamples)), first, last};
  }

  struct Choice {
    int way;
    double volume;  // about that of the boxes of its parts, or of theirs `more` cuts later
  };
  Choice best_way(const Branch& branch, int more) {
    const Ways ways = ways_of(branch.box);
    Choice best{ways.list[0], kInfinity};
    for (int k = 0; k < ways.count; ++k) {
      const int middle = part(branch, ways.list[k]);
      if (middle == branch.last) continue;
      const Branch left = sampled(branch.first, middle), right = sampled(middle, branch.last);
      const double volume = more == 0 ? left.box.half.prod() + right.box.half.prod()
                                      : least_volume(left) + least_volume(right);
      if (volume < (k == 0 ? 1.0 : kOther) * best.volume) best = {ways.list[k], volume};
    }
    return best;
  }
  double least_volume(const Branch& branch) {
    return branch.last - branch.first <= kLanes ? branch.box.half.prod()
                                                : best_way(branch, 0).volume;
  }

  // Across the longest side of its box, or where that makes the boxes much thinner, as around a
  // cylinder or at an edge. The first cut through a closed ring or tube saves nothing: the second
  // one tells.
  void split(int index) {
    const Branch branch = branches_[index];
    if (branch.last - branch.first <= kLanes) return;
    int way = ways_of(branch.box).list[0];
    if (ways_of(branch.box).count > 1) {
      Choice choice = best_way(branch, 0);
      if (choice.volume > kSaved * branch.box.half.prod()) choice = best_way(branch, 1);
      way = choice.way;
    }
    const int middle = part(branch, way), left = static_cast<int>(branches_.size());
    branches_[index].left = left;
    branches_.push_back({fit(branch.first, middle), branch.first, middle});
    branches_.push_back({fit(middle, branch.last), middle, branch.last});
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
      const int thinnest = box.half.least();
      for (int k = 0; k < 3; ++k) {
        const int from = k == ObbTree::kFlatAxis ? thinnest
                         : k == thinnest         ? ObbTree::kFlatAxis
                                                 : k;
        node.center[k][lane] = static_cast<float>(box.center[k]);
        node.half[k][lane] = static_cast<float>(box.half[from] + kBoxPadding * tree_.size);
        for (int j = 0; j < 3; ++j) node.axis[k][j][lane] = static_cast<float>(box.axes(from, j));
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
  std::vector<Vec3> middles_, normals_;  // of the triangles
  double padding_;
  std::vector<Branch> branches_;
  ObbTree tree_;
};

}  // namespace

ObbTree make_obb_tree(const MeshTopology& topology) { return TreeBuilder(topology).build(); }

}  // namespace volcontact
