// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/column_regions.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/disjoint_sets.h"

namespace volcontact {
namespace {

constexpr double kNoArea =
    4.0;  // by the rounding along the outlines of a face's cells: they cancel
constexpr double kTouch = 1e-9;   // of an edge: how far a point may be off it
constexpr int kMostStacked = 64;  // cells of a face that are compared with each other
constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

std::uint64_t key_of(int f, int g) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(f)) << 32 |
         static_cast<std::uint32_t>(g);
}

// Cells by their faces, and which of their sides are joined.
class Joiner {
 public:
  Joiner(const ObbTree& a, const ObbTree* b, std::vector<ColumnCell>& cells, RegionScratch& scratch)
      : a_(a), b_(b), cells_(cells), scratch_(scratch) {
    std::size_t size = 16;
    while (size < 2 * cells.size()) size *= 2;
    mask_ = size - 1;
    scratch.keys.assign(size, kEmpty);
    scratch.cell_at.resize(size);
    make_sets(scratch.parent, 2 * cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::uint64_t key = key_of(cells[i].f, cells[i].g);
      std::size_t at = home(key);
      while (scratch.keys[at] != kEmpty) at = (at + 1) & mask_;
      scratch.keys[at] = key;
      scratch.cell_at[at] = static_cast<int>(i);
    }
  }

  int find(int i) { return root_of(scratch_.parent, i); }
  void join(int i, int j) { join_sets(scratch_.parent, i, j); }

  // The cell across the edges of a label; -1 where there is none.
  int across(const ColumnCell& cell, int label) const {
    const bool of_f = label < 3;
    if (b_ == nullptr) return of_f ? cell_of(a_.twins[3 * cell.f + label] / 3, cell.g) : -1;
    const int f = of_f ? a_.twins[3 * cell.f + label] / 3 : cell.f;
    const int g = of_f ? cell.g : b_->twins[3 * cell.g + label - 3] / 3;
    const int next = cell_of(f, g);
    return next >= 0 ? next : across_both(cell, label, f, g);
  }

 private:
  // By high bits, the only ones that both faces have a part in.
  std::size_t home(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 36) & mask_;
  }
  int cell_of(int f, int g) const {
    const std::uint64_t key = key_of(f, g);
    for (std::size_t at = home(key); scratch_.keys[at] != kEmpty; at = (at + 1) & mask_) {
      if (scratch_.keys[at] == key) return scratch_.cell_at[at];
    }
    return -1;
  }

  // Where an edge of f lies on an edge of g, the next cell is across both of them.
  int across_both(const ColumnCell& cell, int label, int f, int g) const {
    const bool of_f = label < 3;
    for (int k = 0; k < 3; ++k) {
      const int next = of_f ? cell_of(f, b_->twins[3 * cell.g + k] / 3)
                            : cell_of(a_.twins[3 * cell.f + k] / 3, g);
      if (next < 0) continue;
      for (int i = 0; i < cell.count; ++i) {
        if (cell.label[i] != label) continue;
        const int j = i + 1 == cell.count ? 0 : i + 1;
        const double x = 0.5 * (cell.x[i] + cell.x[j]), y = 0.5 * (cell.y[i] + cell.y[j]);
        if (cells_[next].covers(x, y, kTouch)) return next;
      }
    }
    return -1;
  }

  const ObbTree& a_;
  const ObbTree* b_;
  std::vector<ColumnCell>& cells_;
  RegionScratch& scratch_;
  std::size_t mask_;
};

// Calls visit(first, last) for the runs of equal faces in the cells sorted by that face.
template <typename FaceOf, typename Visit>
void for_faces(const std::vector<ColumnCell>& cells, RegionScratch& scratch, FaceOf&& face_of,
               Visit&& visit) {
  // A face and its cell as one number: sorted without a look at the cells, which often come so.
  std::vector<std::uint64_t>& keys = scratch.keys_of_faces;
  keys.resize(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    keys[i] = key_of(face_of(cells[i]), static_cast<int>(i));
  }
  if (!std::is_sorted(keys.begin(), keys.end())) std::sort(keys.begin(), keys.end());
  std::vector<int>& order = scratch.order;
  order.resize(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) order[i] = static_cast<int>(keys[i] & 0xffffffffu);
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    last = first + 1;
    while (last < order.size() && keys[last] >> 32 == keys[first] >> 32) ++last;
    visit(order.data() + first, order.data() + last);
  }
}

// What one side of the cells knows of its faces: whether a column passes through several faces of
// the other body there (the cells of the face then overlap and cancel each other), and whether
// anything is left.
struct Side {
  int offset;  // of its elements
  int (*face_of)(const ColumnCell&);
  int (*sign_of)(const ColumnCell&);  // +1 for a cell that adds to the area of the face
  // Height of the other body's face, positive away from this one.
  double (*beyond)(const ColumnCell&, double x, double y);
};
constexpr Side kSides[2] = {
    {0, [](const ColumnCell& c) { return c.f; },
     [](const ColumnCell& c) { return static_cast<int>(c.sign_g); },
     [](const ColumnCell& c, double x, double y) { return c.height_of_g(x, y); }},
    {1, [](const ColumnCell& c) { return c.g; },
     [](const ColumnCell& c) { return static_cast<int>(-c.sign_f); },
     [](const ColumnCell& c, double x, double y) { return -c.height_of_f(x, y); }},
};

// Joins what stands on one upright face: the cells above and below it know it by its slot, and
// those beside it in its plane by the face that they share.
void join_wall(Joiner& joiner, const ObbTree& tree, int label, const ColumnCell& cell, int index,
               RegionScratch& scratch) {
  const bool of_a = label < 3;
  const int element = 2 * index + (of_a ? 0 : 1);
  const int slot = tree.twins[of_a ? 3 * cell.f + label : 3 * cell.g + label - 3] / 3;
  for (const RegionScratch::Wall& wall : scratch.walls) {
    if (wall.of_a != of_a) continue;
    bool same = wall.slot == slot;
    for (int i = 0; i < 3 && !same; ++i) same = tree.twins[3 * slot + i] / 3 == wall.slot;
    if (same) joiner.join(wall.element, element);
  }
  scratch.walls.push_back({slot, element, of_a});
}

// Whether another cell of the same face ends nearer to it above or below the middle of this one:
// then what lies between this cell's two faces is not all of the overlap.
bool is_blocked(const std::vector<ColumnCell>& cells, int cell, const Side& side, const int* first,
                const int* last) {
  const ColumnCell& own = cells[cell];
  double x = 0.0, y = 0.0;
  for (int i = 0; i < own.count; ++i) {
    x += own.x[i] / own.count;
    y += own.y[i] / own.count;
  }
  const double end = side.beyond(own, x, y);
  return std::any_of(first, last, [&](int i) {
    return i != cell && side.beyond(cells[i], x, y) < end && cells[i].covers(x, y);
  });
}

// At most; what their corners are off by, times this, their area is off by.
double length_of_outlines(const std::vector<ColumnCell>& cells, const int* first, const int* last) {
  double length = 0.0;
  for (; first != last; ++first) {
    const ColumnCell& cell = cells[*first];
    for (int i = 0, before = cell.count - 1; i < cell.count; before = i++) {
      length += std::abs(cell.x[i] - cell.x[before]) + std::abs(cell.y[i] - cell.y[before]);
    }
  }
  return length;
}

}  // namespace

bool is_layered(const std::vector<ColumnCell>& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const ColumnCell& c) { return c.sign_f > 0 || c.sign_g < 0; });
}

namespace {

// Cells over a half-space that stand side by side, one for each face: its neighbours are known.
int find_regions_below(const ObbTree& a, std::vector<ColumnCell>& cells, RegionScratch& scratch) {
  const int count = static_cast<int>(cells.size());
  std::vector<int>& of_slot = scratch.cell_of_slot;
  if (of_slot.size() < a.triangle_of_slot.size()) of_slot.resize(a.triangle_of_slot.size(), -1);
  make_sets(scratch.parent, cells.size());
  for (int i = 0; i < count; ++i) of_slot[cells[i].f] = i;
  for (int i = 0; i < count; ++i) {
    ColumnCell& cell = cells[i];
    for (int label = 0; label < 3; ++label) {
      if ((cell.labels & 1u << label) == 0) continue;
      const int other = of_slot[a.twins[3 * cell.f + label] / 3];
      if (other < 0) {
        cell.walls = static_cast<unsigned char>(cell.walls | 1u << label);
      } else if (other < i) {
        join_sets(scratch.parent, i, other);
      }
    }
  }
  scratch.region_of.resize(cells.size());
  scratch.number.assign(cells.size(), -1);
  int regions = 0;
  for (int i = 0; i < count; ++i) {
    int& number = scratch.number[root_of(scratch.parent, i)];
    if (number < 0) number = regions++;
    scratch.region_of[i] = {number, number, cells[i].walls != 0 ? number : -1, -1};
    of_slot[cells[i].f] = -1;
  }
  return regions;
}

}  // namespace

int find_regions(const ObbTree& a, const ObbTree* b, double rounding,
                 std::vector<ColumnCell>& cells, RegionScratch& scratch) {
  scratch.left_out = 0.0;
  if (b == nullptr && !is_layered(cells)) return find_regions_below(a, cells, scratch);
  const int count = static_cast<int>(cells.size());
  Joiner joiner(a, b, cells, scratch);
  // 0: no part of the surface; 1: its cells lie side by side; 2: they overlap.
  std::vector<int>& state = scratch.number;
  state.assign(2 * cells.size(), 1);
  const bool layered = is_layered(cells);
  scratch.walls.clear();
  // Of layered cells: whether the column between the two faces is overlap.
  std::vector<unsigned char>& solid = scratch.solid;
  solid.assign(cells.size(), 1);
  const double no_area = kNoArea * rounding;
  const double longest_outline = 8.0 * a.size;  // that of a square around the mesh
  for (int s = 0; layered && s < 2; ++s) {
    const Side& side = kSides[s];
    for_faces(cells, scratch, side.face_of, [&](const int* first, const int* last) {
      double net = 0.0;
      bool mixed = false;
      for (const int* i = first; i != last; ++i) {
        const int sign = side.sign_of(cells[*i]);
        net += sign * cells[*i].area;
        mixed |= sign < 0;
      }
      const bool is_none = net <= no_area * static_cast<double>(last - first) * longest_outline &&
                           net <= no_area * length_of_outlines(cells, first, last);
      const int value = is_none ? 0 : mixed ? 2 : 1;
      if (value == 0) scratch.left_out += std::abs(net);
      for (const int* i = first; i != last; ++i) {
        state[2 * *i + side.offset] = value;
        if (value == 2) joiner.join(2 * *first + side.offset, 2 * *i + side.offset);
        if (value != 1 && (side.sign_of(cells[*i]) < 0 || last - first > kMostStacked ||
                           is_blocked(cells, *i, side, first, last))) {
          solid[*i] = 0;
        }
      }
    });
  }
  for (int i = 0; i < count; ++i) {
    ColumnCell& cell = cells[i];
    const bool through = solid[i] != 0 || (cell.labels & 1u << kCrossing) != 0;
    if (through && state[2 * i] != 0 && state[2 * i + 1] != 0) joiner.join(2 * i, 2 * i + 1);
    for (int label = 0; label < kCrossing; ++label) {
      if ((cell.labels & 1u << label) == 0) continue;
      const int other = joiner.across(cell, label);
      if (other < 0) {
        cell.walls = static_cast<unsigned char>(cell.walls | 1u << label);
        continue;
      }
      for (int side = 0; side < 2; ++side) {
        // Across an edge of its own face a surface goes on; across one of the other's, it goes on
        // within the face where the cells lie side by side.
        const bool own = (label < 3) == (side == 0);
        const int s = state[2 * i + side], t = state[2 * other + side];
        if (own ? s != 0 && t != 0 : s == 1 && t == 1) joiner.join(2 * i + side, 2 * other + side);
      }
    }
  }
  constexpr unsigned char kWalls[2] = {0b000111, 0b111000};
  for (int i = 0; layered && i < count; ++i) {
    const ColumnCell& cell = cells[i];
    for (int label = 0; label < kCrossing; ++label) {
      if ((cell.walls & 1u << label) != 0) {
        join_wall(joiner, label < 3 ? a : *b, label, cell, i, scratch);
      }
    }
    // A wall through the other solid, with neither end in it.
    for (int side = 0; side < 2; ++side) {
      if (state[2 * i + side] == 0 && (cell.walls & kWalls[side]) != 0 &&
          state[2 * i + 1 - side] != 0) {
        joiner.join(2 * i, 2 * i + 1);
      }
    }
  }
  scratch.region_of.resize(cells.size());
  int regions = 0;
  scratch.order.assign(2 * cells.size(), -1);  // number of each root
  const auto region = [&](int element, bool counts) {
    if (!counts) return -1;
    int& number = scratch.order[joiner.find(element)];
    if (number < 0) number = regions++;
    return number;
  };
  for (int i = 0; i < count; ++i) {
    scratch.region_of[i] = {
        region(2 * i, state[2 * i] != 0), region(2 * i + 1, state[2 * i + 1] != 0),
        region(2 * i, (cells[i].walls & kWalls[0]) != 0),
        region(2 * i + 1, (cells[i].walls & kWalls[1]) != 0), b == nullptr || solid[i] != 0};
  }
  return regions;
}

}  // namespace volcontact
