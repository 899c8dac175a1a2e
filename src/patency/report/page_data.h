// SPDX-License-Identifier: Apache-2.0
// What the page's script draws, small: points as 16-bit numbers in their box, fields as 16-bit numbers in their range, surfaces with
// the triangles that a screen can show. web/src/model.ts reads it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "patency/report/results.h"

namespace patency {

/// Compressed bytes for the page, in base64, and how to call them.
struct Blob {
    std::string id;
    std::string base64;
};

/// 16 bits per number; this one says that there is no value.
inline constexpr std::uint16_t no_value = 65535;

/// A field's values are low + word / 65534 (high - low).
struct PieceField {
    std::string name, unit;
    double low, high;
};

/// Points, fields, triangles and lines in `words`, one after another: 3 per point, then one per point for every field, 3 per
/// triangle, one per line (how many points it has; they follow each other). Points lie at origin + step * word.
struct Piece {
    std::size_t points = 0, triangles = 0, lines = 0;
    Vec3 origin{};     ///< [mm]
    double step = 0;   ///< [mm]
    std::vector<PieceField> fields{};
    std::vector<std::uint16_t> words{};
};

/// Which points of a PolyData are shown, and how they are joined; at most 65535.
struct Shown {
    std::vector<std::uint32_t> points;
    std::vector<std::array<std::uint32_t, 3>> triangles{};   ///< of the shown points
    std::vector<std::size_t> lines{};                        ///< lengths; the points of a line follow each other
};
Shown shown_surface(const PolyData& data, std::size_t most_triangles);
Shown shown_lines(const PolyData& data, std::size_t most_points);
Shown shown_points(const PolyData& data, std::size_t most_points);

/// Fields are vectors' lengths or scalars; those named in `fields` that the data have, under the name given there. Where an array
/// IsResolved is zero there is no value. `with_joints`: triangles and lines too.
struct FieldChoice {
    const char* array;   ///< in the file
    const char* name;    ///< on the page
};
enum class Joints { left_out, included };
Piece make_piece(const PolyData& data, const Shown& shown, const std::vector<FieldChoice>& fields, Joints joints);

struct PageData {
    std::string model;   ///< JSON
    std::vector<Blob> blobs;
};
PageData make_page_data(const RunResults& results);

}   // namespace patency
