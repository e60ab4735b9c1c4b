// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "c_api/volcontact.h"
#include "volcontact/base/fields.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::c_api {

/// A solid with the numbers it was made of, by name; none for meshes, polytopes and composed
/// solids.
struct NamedSolid {
  Shape shape;
  FieldValues values;

  /// A simple shape by its name, with default parameters. Throws std::invalid_argument on a name
  /// that is none.
  static NamedSolid simple(std::string_view shape);

  /// The numbers of a parameter. Throws std::invalid_argument naming those there are.
  const std::vector<double>& get(std::string_view name) const;

  /// The same solid with another value of a parameter. Throws std::invalid_argument.
  NamedSolid with(std::string_view name, const double* numbers, int count) const;

  /// Unit and range of a parameter.
  struct Row {
    std::string name, unit, range;
  };
  std::vector<Row> rows() const;
};

/// Copies metrics to their plain form.
vc_metrics plain(const VolumeMetrics& metrics) noexcept;

/// `count` numbers as a list. Throws std::invalid_argument where there are none.
std::vector<double> numbers_from(const double* numbers, int count, std::string_view name);

}  // namespace volcontact::c_api

struct vc_solid {
  volcontact::c_api::NamedSolid named;
};
