// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_sites.h"

#include <algorithm>
#include <limits>

#include "volcontact/base/disjoint_sets.h"

namespace volcontact {
namespace {

constexpr double kSpeck = 1e-3;  // of the volume
constexpr int kLeavesPerTask = 16;

// The leaves and their regions: disjoint sets.
class Regions {
 public:
  Regions(ThreadTeam& team, std::span<const Cell> cells, const std::vector<int>& leaves,
          SiteScratch& scratch)
      : s_(scratch), count_(static_cast<int>(leaves.size())) {
    make_sets(s_.parent, leaves.size());
    s_.leaves.resize(leaves.size());
    team.for_each(count_, kLeavesPerTask, [&](int i) {
      const Cell& cell = cells[leaves[i]];
      s_.leaves[i] = {{cell.center + cell.content_low, cell.center + cell.content_high},
                      cell.sums.volume,
                      cell.low};
    });
  }

  double volume(int i) const { return s_.leaves[i].volume; }
  const Vec3& low(int i) const { return s_.leaves[i].box.min; }
  const Vec3& high(int i) const { return s_.leaves[i].box.max; }
  int root(int i) { return root_of(s_.parent, i); }
  void join(int i, int j) { join_sets(s_.parent, i, j); }

  void join_neighbours(double slack);
  void join_specks(double rounding);

 private:
  int sweep_axis() const;

  SiteScratch& s_;
  const int count_;
};

// The axis along which fewest leaves stand side by side.
int Regions::sweep_axis() const {
  Vec3 low = Vec3::Constant(kInfinity), high = -low, sum = Vec3::Zero();
  for (int i = 0; i < count_; ++i) {
    low = low.cwiseMin(this->low(i));
    high = high.cwiseMax(this->high(i));
    sum += this->high(i) - this->low(i);
  }
  const Vec3 least = Vec3::Constant(std::numeric_limits<double>::min());
  return (high - low).cwiseQuotient(sum.cwiseMax(least)).largest();
}

void Regions::join_neighbours(double slack) {
  const int axis = sweep_axis();
  const auto start = [&](int i) { return low(i)[axis]; };
  s_.order.clear();
  for (int i = 0; i < count_; ++i) {
    if (volume(i) > 0.0) s_.order.push_back(i);
  }
  std::sort(s_.order.begin(), s_.order.end(),
            [&](int i, int j) { return start(i) != start(j) ? start(i) < start(j) : i < j; });
  const auto touching = [&](int i, int j) {
    const Vec3 overlap = high(i).cwiseMin(high(j)) - low(i).cwiseMax(low(j));
    const auto wide =
        std::count_if(overlap.begin(), overlap.end(), [&](double x) { return x > slack; });
    return overlap.minCoeff() >= -slack && wide >= 2;
  };
  for (auto i = s_.order.begin(); i != s_.order.end(); ++i) {
    const double end = high(*i)[axis] + slack;
    for (auto j = i + 1; j != s_.order.end() && start(*j) <= end; ++j) {
      if (touching(*i, *j)) join(*i, *j);
    }
  }
}

// A speck of estimated volume beside the overlap would come and go with the pose.
void Regions::join_specks(double rounding) {
  double total = 0.0;
  for (int i = 0; i < count_; ++i) total += volume(i);
  s_.weight.assign(s_.leaves.size(), 0.0);
  s_.certain.assign(s_.leaves.size(), 0.0);
  for (int i = 0; i < count_; ++i) {
    s_.weight[root(i)] += volume(i);
    s_.certain[root(i)] += s_.leaves[i].certain;
  }
  for (int i = 0; i < count_; ++i) {
    if (s_.certain[i] > rounding) s_.weight[i] += total;
  }
  const auto stands = [&](int i) { return s_.weight[root(i)] > kSpeck * total; };
  int last = 0;
  while (last < count_ && !stands(last)) ++last;
  if (last == count_) return;
  for (int i = 0; i < count_; ++i) {
    if (stands(i)) {
      last = i;
      continue;
    }
    int nearest = last;  // good enough where there is no volume at all
    if (volume(i) > 0.0) {
      const Vec3 middle = s_.leaves[i].box.center();
      double least = kInfinity;
      for (int j = 0; j < count_; ++j) {
        const double distance = (s_.leaves[j].box.center() - middle).squaredNorm();
        if (!(distance < least) || !(volume(j) > 0.0) || !stands(j)) continue;
        least = distance;
        nearest = j;
      }
    }
    const double weight = s_.weight[root(nearest)];
    join(i, nearest);
    s_.weight[root(i)] = weight;
  }
}

}  // namespace

void sort_by_site(ThreadTeam& team, std::span<const Cell> cells, double slack, double rounding,
                  std::vector<int>& leaves, std::vector<int>& ends, SiteScratch& scratch) {
  ends.clear();
  if (leaves.empty()) return;
  Regions regions(team, cells, leaves, scratch);
  regions.join_neighbours(slack);
  regions.join_specks(rounding);
  const int count = static_cast<int>(leaves.size());
  // Counting sort by region, in the order of their first leaves.
  scratch.order.assign(leaves.size(), -1);
  for (int i = 0; i < count; ++i) {
    int& site = scratch.order[regions.root(i)];
    if (site < 0) {
      site = static_cast<int>(ends.size());
      ends.push_back(0);
    }
    ++ends[site];
  }
  int next = 0;
  for (int& end : ends) {
    const int size = end;
    end = next;
    next += size;
  }
  scratch.sorted.resize(leaves.size());
  for (int i = 0; i < count; ++i) {
    scratch.sorted[ends[scratch.order[regions.root(i)]]++] = leaves[i];
  }
  leaves = scratch.sorted;
}

}  // namespace volcontact
