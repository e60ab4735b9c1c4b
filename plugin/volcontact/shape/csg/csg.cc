// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <string>

#include "volcontact/base/check.h"
#include "volcontact/shape/csg/csg_carved.h"
#include "volcontact/shape/csg/csg_metrics.h"
#include "volcontact/shape/csg/csg_pieces.h"

namespace volcontact {
namespace {

constexpr int kMostOperands = 64;  // that wait for their operation

int most_operands(const std::vector<Csg::Step>& steps) {
  int waiting = 0, most = 0;
  for (const Csg::Step& step : steps) {
    waiting += step.member >= 0 ? 1 : -1;
    most = std::max(most, waiting);
  }
  return most;
}

// Runs the tree: leaf(member) makes an operand, join(operation, a, b) changes a.
template <typename Operand, typename Leaf, typename Join>
Operand evaluate(const std::vector<Csg::Step>& steps, Leaf&& leaf, Join&& join) {
  std::array<Operand, kMostOperands> stack;
  int top = -1;
  for (const Csg::Step& step : steps) {
    if (step.member >= 0) {
      stack[++top] = leaf(step.member);
    } else {
      --top;
      join(step.operation, stack[top], stack[top + 1]);
    }
  }
  return stack[0];
}

// A member's signed distance, or minus that where the member is taken off.
struct Nearest {
  double distance = 0.0;
  int member = 0;
  double sign = 1.0;
};

}  // namespace

struct Csg::Data {
  std::vector<Member> members;
  std::vector<Step> steps;
  Aabb bounds;
  double most_volume = 0.0;
  int most_parts = 0;
  mutable std::once_flag pieces_once, carved_once, metrics_once;
  mutable PieceList pieces;
  mutable std::vector<CarvedPiece> carved;
  mutable VolumeMetrics metrics;
};

bool Seam::is_surface(const Vec3& x) const {
  return std::none_of(covered.begin(), covered.end(), [&x](const std::vector<Quadric>& region) {
    return std::all_of(region.begin(), region.end(),
                       [&x](const Quadric& face) { return face(x) <= 0.0; });
  });
}

// The smallest box that the support heights give; nothing left gives a box of no size.
Csg::Csg(const std::shared_ptr<Data>& data) : data_(data) {
  for (int i = 0; i < 3; ++i) {
    double high = support_height(Vec3::Unit(i)), low = -support_height(-Vec3::Unit(i));
    if (low > high) low = high = 0.5 * (low + high);
    data->bounds.max[i] = high;
    data->bounds.min[i] = low;
  }
  data->most_volume = evaluate<double>(
      data_->steps,
      [&](int i) {
        return std::visit([](const auto& shape) { return shape.own_metrics().volume; },
                          data_->members[i].shape);
      },
      [](Operation operation, double& a, double b) {
        if (operation == Operation::kUnion) a += b;
        if (operation == Operation::kIntersection) a = std::min(a, b);
      });
  if (data_->bounds.bounded()) {
    const double box = (data_->bounds.max - data_->bounds.min).prod();
    data->most_volume = std::min(data->most_volume, box);
  }
  // Each member begins and ends a part at most as often as a line has parts in it.
  for (const Member& member : data_->members) {
    data->most_parts += std::holds_alternative<Torus>(member.shape) ? 2 : 1;
  }
}

Csg::Csg(const SimpleShape& member, const Pose& X_SM) : Csg(one_member(member, X_SM)) {}
Csg::Csg(Operation operation, const Csg& a, const Csg& b) : Csg(joined(operation, a, b)) {}

std::shared_ptr<Csg::Data> Csg::one_member(const SimpleShape& member, const Pose& X_SM) {
  auto data = std::make_shared<Data>();
  data->members.push_back({member, X_SM, X_SM.inverse()});
  data->steps.push_back({0});
  return data;
}

std::shared_ptr<Csg::Data> Csg::joined(Operation operation, const Csg& a, const Csg& b) {
  auto data = std::make_shared<Data>();
  data->members = a.members();
  data->members.insert(data->members.end(), b.members().begin(), b.members().end());
  require(data->members.size() <= kMostMembers,
          "csg: a solid of " + std::to_string(data->members.size()) +
              " members is too large: at most " + std::to_string(kMostMembers));
  data->steps = a.steps();
  for (Step step : b.steps()) {
    if (step.member >= 0) step.member += static_cast<int>(a.members().size());
    data->steps.push_back(step);
  }
  data->steps.push_back({-1, operation});
  require(most_operands(data->steps) <= kMostOperands,
          "csg: the operations are nested too deeply to the right: at most " +
              std::to_string(kMostOperands));
  return data;
}

Csg Csg::posed(const Pose& X_WS) const {
  auto data = std::make_shared<Data>();
  data->members = data_->members;
  data->steps = data_->steps;
  for (Member& member : data->members) {
    member.X_SM = X_WS * member.X_SM;
    member.X_MS = member.X_SM.inverse();
  }
  return Csg(data);
}

const std::vector<Csg::Member>& Csg::members() const { return data_->members; }
const std::vector<Csg::Step>& Csg::steps() const { return data_->steps; }

Aabb Csg::bounds() const { return data_->bounds; }

double Csg::most_volume() const { return data_->most_volume; }

int Csg::most_parts() const { return data_->most_parts; }

double Csg::support_height(const Vec3& e) const {
  return evaluate<double>(
      data_->steps,
      [&](int i) {
        const Member& member = data_->members[i];
        // Transposed, not multiplied: a half-space is bounded along its exact normal only.
        const Vec3 e_M = member.X_SM.rotation.transpose() * e;
        const double height =
            std::visit([&](const auto& shape) { return shape.support_height(e_M); }, member.shape);
        return height + e.dot(member.X_SM.translation);
      },
      [](Operation operation, double& a, double b) {
        if (operation == Operation::kUnion) a = std::max(a, b);
        if (operation == Operation::kIntersection) a = std::min(a, b);
      });
}

double Csg::signed_distance(const Vec3& p) const {
  return evaluate<double>(
      data_->steps,
      [&](int i) {
        const Member& member = data_->members[i];
        const Vec3 p_M = member.X_MS * p;
        return std::visit([&](const auto& shape) { return shape.signed_distance(p_M); },
                          member.shape);
      },
      [](Operation operation, double& a, double b) {
        if (operation == Operation::kUnion) a = std::min(a, b);
        if (operation == Operation::kIntersection) a = std::max(a, b);
        if (operation == Operation::kDifference) a = std::max(a, -b);
      });
}

Vec3 Csg::gradient(const Vec3& p) const {
  const Nearest nearest = evaluate<Nearest>(
      data_->steps,
      [&](int i) -> Nearest {
        const Member& member = data_->members[i];
        const Vec3 p_M = member.X_MS * p;
        return {
            std::visit([&](const auto& shape) { return shape.signed_distance(p_M); }, member.shape),
            i, 1.0};
      },
      [](Operation operation, Nearest& a, const Nearest& b) {
        if (operation == Operation::kUnion && b.distance < a.distance) a = b;
        if (operation == Operation::kIntersection && b.distance > a.distance) a = b;
        if (operation == Operation::kDifference && -b.distance > a.distance) {
          a = {-b.distance, b.member, -b.sign};
        }
      });
  const Member& member = data_->members[nearest.member];
  const Vec3 p_M = member.X_MS * p;
  const Vec3 gradient_M =
      std::visit([&](const auto& shape) { return shape.gradient(p_M); }, member.shape);
  return nearest.sign * (member.X_SM.rotation * gradient_M);
}

void Csg::pieces(PieceList& list) const {
  std::call_once(data_->pieces_once, [this] { data_->pieces = csg_pieces(*this); });
  for (int i = 0; i < data_->pieces.size(); ++i) {
    for (const Quadric* face = data_->pieces.begin(i); face != data_->pieces.end(i); ++face) {
      list.add(*face);
    }
    list.end_piece();
  }
}

const std::vector<CarvedPiece>& Csg::carved_pieces() const {
  std::call_once(data_->carved_once, [this] { data_->carved = csg_carved_pieces(*this); });
  return data_->carved;
}

VolumeMetrics Csg::own_metrics() const {
  std::call_once(data_->metrics_once, [this] { data_->metrics = csg_own_metrics(*this); });
  return data_->metrics;
}

void Csg::prepare() const {
  PieceList list;
  pieces(list);
  carved_pieces();
  own_metrics();
}

}  // namespace volcontact
