// SPDX-License-Identifier: Apache-2.0
#include "patency/io/polydata_file.h"

#include <gtest/gtest.h>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

/// Coordinates and fields are 32-bit floats in the file: equal to seven digits.
TEST(PolydataFile, ReadsWhatWasWritten) {
    const ScratchFolder folder;
    PolyData data{.points = {{0, 0, 0}, {1e-3, 0, 0}, {1e-3, 2e-3, 0}, {0, 2e-3, 5e-3}},
                  .lines = {},
                  .triangles = {{0, 1, 2}, {0, 2, 3}},
                  .space = "LPS"};
    data.arrays = {{"pressure", "Pa", 1, {1, -2.5, 3, 1e4}},
                   {"wall_shear_stress", "Pa", 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}};
    write_polydata(folder / "a.vtp", data);
    const PolyData read = read_polydata(folder / "a.vtp");
    ASSERT_EQ(read.points.size(), data.points.size());
    for (std::size_t k = 0; k < read.points.size(); ++k) EXPECT_LT(norm(read.points[k] - data.points[k]), 1e-9);
    EXPECT_EQ(read.triangles, data.triangles);
    EXPECT_EQ(read.space, "LPS");
    ASSERT_EQ(read.arrays.size(), 2u);
    EXPECT_EQ(read.arrays[0].name, "Pressure");
    EXPECT_EQ(read.arrays[0].unit, "Pa");
    EXPECT_EQ(read.arrays[0].values, data.arrays[0].values);
    EXPECT_EQ(read.arrays[1].name, "WSS");
    EXPECT_EQ(read.arrays[1].components, 3);
    EXPECT_EQ(read.arrays[1].values, data.arrays[1].values);
}

TEST(PolydataFile, ReadsLines) {
    const ScratchFolder folder;
    write_polydata(folder / "a.vtp",
                   {.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, .lines = {{0, 1, 2}, {3, 2}}});
    const auto lines = read_polydata(folder / "a.vtp").lines;
    EXPECT_EQ(lines, (std::vector<std::vector<std::uint32_t>>{{0, 1, 2}, {3, 2}}));
}

TEST(PolydataFile, SaysWhatIsWrongWithDamagedFiles) {
    const ScratchFolder folder;
    EXPECT_THROW(read_polydata(folder / "none.vtp"), FileError);
    write_polydata(folder / "a.vtp", {.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}});
    const std::string whole = read_file(folder / "a.vtp");
    write_file(folder / "cut.vtp", whole.substr(0, whole.size() / 2));
    EXPECT_THROW(read_polydata(folder / "cut.vtp"), FileError);
    write_file(folder / "text.vtp",   // a triangle of points that are not there
               "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\"><PolyData><Piece "
               "NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
               "NumberOfStrips=\"0\" NumberOfPolys=\"1\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
               "format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points>"
               "<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 7</DataArray><DataArray "
               "type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys>"
               "</Piece></PolyData></VTKFile>");
    EXPECT_THROW(read_polydata(folder / "text.vtp"), FileError);
}

}   // namespace
}   // namespace patency
