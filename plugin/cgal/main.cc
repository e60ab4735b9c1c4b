// SPDX-License-Identifier: GPL-3.0-or-later
// The program volcontact-cgal: judges, repairs and intersects triangle meshes with CGAL.

#include <charconv>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "cgal/json_text.h"
#include "cgal/judge.h"
#include "cgal/off_file.h"
#include "cgal/overlap.h"
#include "cgal/repair.h"
#include "cgal/wrap.h"

namespace volcontact_cgal {
namespace {

constexpr const char* kUsage = R"(Usage:
  volcontact-cgal check MESH.off                     judge a mesh
  volcontact-cgal repair IN.off OUT.off WELD FILL    weld [length], fill holes [0 or 1]
  volcontact-cgal wrap IN.off OUT.off ALPHA OFFSET   wrap; both are lengths
  volcontact-cgal overlap A.off B.off                moments of the exact intersection
OFF files of triangles only. Results are JSON on standard output. Exit status: 0, or 1 with a message.
)";

constexpr std::size_t kMostCrossings = 20;

double number(const std::string& text) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !(value >= 0.0)) {
    throw std::invalid_argument("'" + text + "' is no number from 0 on");
  }
  return value;
}

void add_moments(JsonObject& out, const Moments& m) {
  const auto& i = m.inertia;
  const std::vector<std::array<double, 3>> rows = {
      {i[0], i[3], i[4]}, {i[3], i[1], i[5]}, {i[4], i[5], i[2]}};
  out.add("volume", m.volume).add("centroid", m.centroid).add_text("inertia", json_list(rows));
}

void add_cleaning(JsonObject& out, const Cleaning& c) {
  out.add("points_welded", c.points_welded)
      .add("faces_folded", c.faces_folded)
      .add("faces_twice", c.faces_twice);
}

JsonObject check(const std::string& path) {
  const Judgement j = judge(read_off(path), kMostCrossings);
  JsonObject out;
  add_cleaning(out, j.cleaning);
  out.add("is_surface", j.is_surface)
      .add("closed", j.closed)
      .add("oriented", j.oriented)
      .add("outward", j.outward)
      .add("bounds_volume", j.bounds_volume)
      .add("parts", j.parts)
      .add("crossings", j.crossings);
  out.add_text("shown", json_objects(j.shown, [](const Crossing& c) {
                 const std::vector<std::size_t> faces = {c.face_a, c.face_b};
                 return JsonObject().add_text("faces", json_list(faces)).add("place", c.place);
               }));
  add_moments(out, j.moments);
  return out;
}

JsonObject repair_file(const std::string& in, const std::string& out_path, double weld, bool fill) {
  Soup soup = read_off(in);
  const RepairReport r = repair(soup, {.weld = weld, .fill = fill});
  write_off(soup, out_path);
  JsonObject out;
  add_cleaning(out, r.cleaning);
  out.add("points_doubled", r.points_doubled)
      .add("faces_turned", r.faces_turned)
      .add("edges_stitched", r.edges_stitched)
      .add("turned", r.turned);
  return out.add_text("holes", json_objects(r.holes, [](const Hole& h) {
                        return JsonObject()
                            .add("edges", h.edges)
                            .add("low", h.low)
                            .add("high", h.high)
                            .add("filled", h.filled);
                      }));
}

JsonObject wrap_file(const std::string& in, const std::string& out_path, double alpha,
                     double offset) {
  if (alpha == 0.0 || offset == 0.0) throw std::invalid_argument("a wrap needs lengths above 0");
  Soup soup = read_off(in);
  clean(soup, 0.0);
  if (soup.faces.empty()) throw std::invalid_argument(in + " has no face");
  soup = wrap(soup, alpha, offset);
  write_off(soup, out_path);
  return JsonObject().add("faces", soup.faces.size());
}

JsonObject overlap_files(const std::string& a, const std::string& b) {
  const Overlap o = overlap(read_off(a), read_off(b));
  JsonObject out;
  add_moments(out, o.moments);
  return out.add("faces", o.faces).add("parts", o.parts);
}

int run(const std::vector<std::string>& arguments) {
  const std::string command = arguments.empty() ? "" : arguments[0];
  const std::size_t count = arguments.size();
  JsonObject result;
  if (command == "check" && count == 2) {
    result = check(arguments[1]);
  } else if (command == "repair" && count == 5) {
    result =
        repair_file(arguments[1], arguments[2], number(arguments[3]), number(arguments[4]) != 0);
  } else if (command == "wrap" && count == 5) {
    result = wrap_file(arguments[1], arguments[2], number(arguments[3]), number(arguments[4]));
  } else if (command == "overlap" && count == 3) {
    result = overlap_files(arguments[1], arguments[2]);
  } else {
    std::fputs(kUsage, stderr);
    return 1;
  }
  std::puts(result.text().c_str());
  return 0;
}

}  // namespace
}  // namespace volcontact_cgal

int main(int count, char** words) {
  try {
    return volcontact_cgal::run({words + 1, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
