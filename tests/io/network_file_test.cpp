// SPDX-License-Identifier: Apache-2.0
#include "patency/io/network_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "patency/base/errors.h"
#include "patency/io/surface_file.h"
#include "patency/shape/flat_loop.h"
#include "patency/shape/network_field.h"
#include "patency/shape/network_lumen.h"
#include "patency/shape/surface_cut.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

namespace fs = std::filesystem;
const fs::path project = PATENCY_SOURCE_DIR;

const std::string json = R"({"unit": "mm", "blend_width_k": 0.2, "tubes": [
  {"name": "trunk", "points": [[0, 0, 0, 2], [5, 0, 0, 2], [10, 0, 0, 2]]},
  {"name": "left", "points": [[10, 0, 0, 1.5], [18, 8, 0, 1.5]]},
  {"name": "right", "points": [[10, 0, 0, 1.2], [18, -8, 0, 1.2]]}]})";
const std::string swc = "# a Y\n1 2 0 0 0 2 -1\n2 2 5 0 0 2 1\n\n3 2 10 0 0 2 2\n4 2 18 8 0 1.5 3\n5 2 18 -8 0 1.2 3\n";
const std::string vtk =
    "# vtk DataFile Version 3.0\nY\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 5 0 0 10 0 0 18 8 0 18 -8 0\n"
    "LINES 2 10\n4 0 1 2 3\n4 0 1 2 4\nPOINT_DATA 5\nSCALARS Radius float 1\nLOOKUP_TABLE default\n2 2 2 1.5 1.2\n";
const std::string vtp =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
    "<Piece NumberOfPoints=\"5\" NumberOfVerts=\"0\" NumberOfLines=\"2\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">"
    "<PointData><DataArray type=\"Float64\" Name=\"MaximumInscribedSphereRadius\" format=\"ascii\">2 2 2 1.5 "
    "1.2</DataArray></PointData>"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 5 0 0 10 0 0 18 8 0 18 -8 "
    "0</DataArray></Points>"
    "<Lines><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 0 1 2 4</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 "
    "8</DataArray></Lines></Piece></PolyData></VTKFile>\n";

std::string replaced(std::string text, std::string_view old, std::string_view with) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    return text.replace(at, old.size(), with);
}

class NetworkFile : public ::testing::Test {
protected:
    Network read(const std::string& name, const std::string& contents, std::string_view unit = "mm") {
        put(folder_ / name, contents);
        return read_network(folder_ / name, unit);
    }
    template <class E>
    std::string refused(const std::string& name, const std::string& contents, std::string_view unit = "mm") {
        return sentence_of<E>([&] { read(name, contents, unit); });
    }
    ScratchFolder folder_;
};

TEST_F(NetworkFile, everyFormatIsTheSameY) {
    for (const auto& [name, contents] :
         {std::pair<std::string, std::string>{"y.json", json}, {"y.swc", swc}, {"y.vtk", vtk}, {"y.vtp", vtp}}) {
        SCOPED_TRACE(name);
        const Network network = read(name, contents);
        EXPECT_TRUE(holds_network(folder_ / name));
        ASSERT_EQ(network.tubes.size(), 3u);
        EXPECT_EQ(network.tubes[0].points.size(), 3u);
        EXPECT_NEAR(length_of(network.tubes[0]), 10e-3, 1e-12);
        EXPECT_NEAR(narrowest_diameter(network), 2.4e-3, 1e-9);
        const std::vector<Opening> openings = openings_of(network, 0);
        ASSERT_EQ(openings.size(), 3u);
        EXPECT_EQ(openings[0].name, "inlet");
        EXPECT_NEAR(openings[0].radius, 2e-3, 1e-9);
        EXPECT_NEAR(openings[0].normal.x, -1, 1e-12);
        EXPECT_EQ(openings[1].name, name == "y.json" ? "outlet_left" : "outlet_1");
        EXPECT_NEAR(openings[2].radius, 1.2e-3, 1e-9);
        EXPECT_EQ(network.blend, name == "y.json" ? 0.2e-3 : 0);
    }
    EXPECT_NEAR(narrowest_diameter(read("y.swc", swc, "cm")), 2.4e-2, 1e-9);
    put(folder_ / "t.stl",
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\nendsolid\n");
    EXPECT_FALSE(holds_network(folder_ / "t.stl"));
}

TEST_F(NetworkFile, refusesWithASentence) {
    EXPECT_TRUE(has(refused<UsageError>("y.swc", swc, ""), "does not say its unit"));
    EXPECT_TRUE(has(refused<UsageError>("y.json", json, "cm"), "says that its unit is mm"));
    EXPECT_TRUE(has(refused<UsageError>("y.json", json, "inch"), "no unit"));
    EXPECT_TRUE(has(refused<FileError>("y.json", replaced(json, "\"mm\"", "\"furlong\"")), "furlong"));
    EXPECT_TRUE(has(refused<FileError>("y.json", json.substr(0, 100)), "no sound JSON"));
    EXPECT_TRUE(
        has(refused<FileError>("y.json", replaced(json, "[5, 0, 0, 2]", "[5, 0, 0]")), "point 2 of tube 'trunk'"));
    EXPECT_TRUE(has(refused<FileError>("y.json", replaced(json, "\"tubes\"", "\"tubs\"")), "no 'tubes'"));
    EXPECT_TRUE(
        has(refused<GeometryError>("y.json", replaced(json, "[5, 0, 0, 2]", "[0, 0, 0, 2]")), "same place twice"));
    EXPECT_TRUE(
        has(refused<GeometryError>("y.json", replaced(json, "[5, 0, 0, 2]", "[5, 0, 0, -2]")), "must be positive"));
    EXPECT_TRUE(has(refused<GeometryError>("y.json", replaced(json, "[10, 0, 0, 1.5], [18, 8, 0, 1.5]",
                                                              "[10, 9, 0, 1.5], [18, 9, 0, 1.5]")),
                    "do not hang together"));
    EXPECT_TRUE(has(refused<GeometryError>("y.json", replaced(json, "\"name\": \"left\"", "\"name\": \"right\"")),
                    "names must differ"));
    EXPECT_TRUE(has(refused<FileError>("y.swc", replaced(swc, "2 2 5 0 0 2 1", "2 2 5 0 0 2 9")), "parent 9"));
    EXPECT_TRUE(has(refused<FileError>("y.swc", replaced(swc, "1 2 0 0 0 2 -1", "1 2 0 0 0 2 3")), "circle"));
    EXPECT_TRUE(has(refused<FileError>("y.swc", replaced(swc, "4 2 18 8 0 1.5 3", "4 2 18 8 x 1.5 3")), "line 6"));
    EXPECT_TRUE(has(refused<FileError>("y.vtk", replaced(vtk, "Radius", "Thickness")), "have no radii"));
    EXPECT_TRUE(has(refused<FileError>("y.vtk", replaced(vtk, "4 0 1 2 4\n", "4 0 1 2 77\n")), "beyond the last"));
    EXPECT_TRUE(has(refused<FileError>("y.txt", "a b c"), "no network in a format"));
}

TEST_F(NetworkFile, damagedFilesEndInASentence) {
    std::mt19937 random(3);
    int read_well = 0;
    for (const auto& [name, contents] : {std::pair<std::string, std::string>{"y.json", json}, {"y.swc", swc}})
        for (int round = 0; round < 200; ++round) {
            std::string mutated = contents;
            for (int k = 0; k < 1 + round % 3; ++k) {
                const std::size_t at = random() % mutated.size();
                if (round % 3 == 0) mutated[at] = char(random());
                if (round % 3 == 1) mutated.erase(at, 1 + random() % 9);
                if (round % 3 == 2) mutated.insert(at, mutated.substr(random() % mutated.size(), random() % 12));
            }
            try {
                read(name, mutated);
                ++read_well;
            } catch (const Error&) {}
        }
    EXPECT_GT(read_well, 10);
}

/// The sections of a closed surface across a tube at an arc length [m]: the area of the one around the centreline.
double section_area(const Surface& surface, const Tube& tube, double arc) {
    std::size_t k = 0;
    double at = 0;
    while (at + norm(tube.points[k + 1] - tube.points[k]) < arc) at += norm(tube.points[k + 1] - tube.points[k]), ++k;
    const Vec3 along = normalized(tube.points[k + 1] - tube.points[k]), centre = tube.points[k] + (arc - at) * along;
    Surface half = surface;
    cut_flat(half, {centre, along}, 0);
    double area = 0, nearest = 1;
    for (const FlatLoop& loop : find_loops(half, boundary_edges(edge_uses(half))))
        if (norm(loop.centre - centre) < nearest) nearest = norm(loop.centre - centre), area = loop.area;
    return area;
}

// The paper's bifurcation: its network against the surface that was made of the same curves by other means.
TEST(ReferenceNetwork, hasTheVolumeTheSectionsAndThePlaceOfTheReferenceSurface) {
    const fs::path folder = project / "../shared/reference/coronary_bifurcation";
    if (!fs::exists(folder)) GTEST_SKIP() << "there is no " << folder;
    const Network network = read_network(folder / "network.json", "");
    Surface reference = read_surface(folder / "lumen.stl", "mm");
    merge_points(reference, 0);
    const Surface mine = make_network_surface(network, 0.2e-3);
    EXPECT_NEAR(volume(mine) / volume(reference), 1, 0.003);
    EXPECT_NEAR(area(mine) / area(reference), 1, 0.003);
    for (const Tube& tube : network.tubes)
        for (double share : {0.35, 0.5, 0.75, 0.9}) {
            const double arc = share * length_of(tube), theirs = section_area(reference, tube, arc);
            EXPECT_NEAR(section_area(mine, tube, arc) / theirs, 1, 0.01) << tube.name << ' ' << share;
        }
    // Newton's distance of their points from the network's wall; those of the caps are left out.
    const NetworkField field(network);
    const std::vector<Opening> openings = openings_of(network, 0);
    double largest = 0;
    for (const Vec3& x : reference.points) {
        bool is_cap = false;
        for (const Opening& o : openings)
            is_cap |= norm(x - o.centre) < 1.01 * o.radius && std::abs(opening_coordinates(o, x).s) < 0.02e-3;
        const Vec3 slope{(field.value(x + Vec3{1e-7, 0, 0}) - field.value(x - Vec3{1e-7, 0, 0})) / 2e-7,
                         (field.value(x + Vec3{0, 1e-7, 0}) - field.value(x - Vec3{0, 1e-7, 0})) / 2e-7,
                         (field.value(x + Vec3{0, 0, 1e-7}) - field.value(x - Vec3{0, 0, 1e-7})) / 2e-7};
        if (!is_cap) largest = std::max(largest, std::abs(field.value(x)) / norm(slope));
    }
    EXPECT_LT(largest, 0.1e-3);
}

// The project's own copy is healthy; the lesion of its deck makes it the diseased one.
TEST(ReferenceNetwork, healthyCopyAndLesionGiveTheReference) {
    const fs::path folder = project / "../shared/reference/coronary_bifurcation";
    if (!fs::exists(folder)) GTEST_SKIP() << "there is no " << folder;
    Network mine = read_network(project / "cases/coronary_bifurcation.json", "");
    EXPECT_NEAR(narrowest_diameter(mine), 2.5e-3, 1e-9);   // the smallest outlet
    add_lesion(mine, {.tube = "anterior_descending", .position = 23.0156e-3, .length = 10e-3, .stenosis = 0.65 / 1.65});
    EXPECT_NEAR(narrowest_diameter(mine), 2e-3, 1e-6);
    EXPECT_NEAR(100 * (1 - narrowest_diameter(mine) / 3.3e-3), 39, 1);
    const NetworkField a(mine), b(read_network(folder / "network.json", ""));
    for (const Tube& tube : mine.tubes)
        for (const Vec3& x : tube.points) ASSERT_NEAR(a.value(x), b.value(x), 0.01e-3);
}

TEST(PublishedCentrelines, becomeNetworks) {
    const fs::path folder = project / "../shared/data/centerlines";
    if (!fs::exists(folder)) GTEST_SKIP() << "there is no " << folder;
    struct {
        const char *file, *unit;
        std::size_t tubes, openings;
    } files[] = {{"coronary_721A_LAD_diagonal.vtk", "mm", 3, 3},
                 {"aortoiliac_vmtk_centerline.vtp", "mm", 3, 3},
                 {"aortoiliac_simvascular_centerlines.vtp", "cm", 3, 3}};
    for (const auto& f : files) {
        SCOPED_TRACE(f.file);
        const Network network = read_network(folder / f.file, f.unit);
        EXPECT_EQ(network.tubes.size(), f.tubes);
        EXPECT_EQ(openings_of(network, 0).size(), f.openings);
    }
    EXPECT_GT(read_network(folder / "cerebral_BraVa_P1.swc", "mm").tubes.size(), 100u);
}

}   // namespace
}   // namespace patency
