// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "c_api/volcontact.h"

namespace volcontact::c_api::testing {

template <auto kFree>
struct Free {
  template <typename T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Solid = std::unique_ptr<vc_solid, Free<vc_solid_free>>;
using Model = std::unique_ptr<vc_model, Free<vc_model_free>>;
using Workspace = std::unique_ptr<vc_workspace, Free<vc_workspace_free>>;

inline Solid solid(const char* shape, const char* parameter = nullptr,
                   std::initializer_list<double> numbers = {}) {
  vc_solid* made = nullptr;
  EXPECT_EQ(vc_solid_create(shape, &made), 0) << vc_error();
  if (parameter) {
    EXPECT_EQ(vc_solid_set(made, parameter, std::data(numbers), static_cast<int>(numbers.size())),
              0)
        << vc_error();
  }
  return Solid(made);
}

inline Model empty_model() {
  vc_model* made = nullptr;
  EXPECT_EQ(vc_model_create(&made), 0);
  return Model(made);
}

inline Model model_of(const Solid& a, const Solid& b) {
  Model model = empty_model();
  EXPECT_EQ(vc_model_add_pair(model.get(), a.get(), nullptr, b.get(), nullptr), 0) << vc_error();
  return model;
}

inline int set(const Model& model, const char* name, double number) {
  return vc_model_set(model.get(), name, &number, 1);
}

inline Workspace workspace() {
  vc_workspace* made = nullptr;
  EXPECT_EQ(vc_workspace_create(&made), 0);
  return Workspace(made);
}

/// A at (x, y, z), turned about z, B at the origin; both at rest.
inline vc_motion at(double x, double y, double z, double turn = 0.0) {
  vc_motion motion{};
  for (double* pose : {motion.X_WA, motion.X_WB}) {
    for (int i = 0; i < 16; i += 5) pose[i] = 1.0;
  }
  motion.X_WA[0] = motion.X_WA[5] = std::cos(turn);
  motion.X_WA[4] = std::sin(turn);
  motion.X_WA[1] = -motion.X_WA[4];
  motion.X_WA[3] = x;
  motion.X_WA[7] = y;
  motion.X_WA[11] = z;
  return motion;
}

/// Whether the call failed with this code and vc_error() has these parts in it.
inline ::testing::AssertionResult fails(int code, int wanted,
                                        std::initializer_list<const char*> parts) {
  const std::string text = vc_error();
  if (code != wanted) {
    return ::testing::AssertionFailure() << "returned " << code << ", last error: " << text;
  }
  for (const char* part : parts) {
    if (text.find(part) == std::string::npos) {
      return ::testing::AssertionFailure() << "'" << text << "' does not contain '" << part << "'";
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace volcontact::c_api::testing
