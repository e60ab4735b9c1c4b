// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cgal/soup.h"

namespace volcontact_cgal {

/// Reads an OFF file of triangles: "OFF", the numbers of points, faces and edges, then the points,
/// then the faces as "3 i j k". Throws std::invalid_argument that names the file and the element.
Soup read_off(const std::string& path);

/// Writes the same, each number with the digits that give it back exactly.
/// Throws std::runtime_error if it cannot.
void write_off(const Soup& soup, const std::string& path);

}  // namespace volcontact_cgal
