// SPDX-License-Identifier: Apache-2.0
// Centreline files as VTK sees them, and centrelines against those that others published (../shared/data/INDEX.md).
#include "patency/io/centreline_file.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "patency/io/surface_file.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/surface_openings.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

vtkSmartPointer<vtkPolyData> read(const fs::path& path) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    return reader->GetOutput();
}

TEST(CentrelineFile, HasTheArraysThatPeersRead) {
    const Lumen cone = make_cone({.length = 10e-3, .inlet_radius = 2e-3, .outlet_radius = 1e-3});
    const BranchedLines vessel = find_branches(find_centrelines(cone.distance, cone.openings));
    std::vector<std::vector<CrossSection>> sections(1);
    for (const CentrelinePoint& p : vessel.lines[0].points)
        sections[0].push_back(
            {.place = p.place, .normal = p.tangent, .area = 4e-6, .is_closed = true, .holds_place = true});
    const ScratchFolder folder;
    write_centrelines(folder / "centerline.vtp", vessel, sections, assess_lesions(vessel, sections), "LPS");
    const auto data = read(folder / "centerline.vtp");
    ASSERT_EQ(data->GetNumberOfLines(), 1);
    ASSERT_EQ(data->GetNumberOfPoints(), vtkIdType(vessel.lines[0].points.size()));
    for (const char* name :
         {"MaximumInscribedSphereRadius", "Abscissas", "BranchId", "BifurcationId", "CenterlineSectionArea",
          "CenterlineSectionNormal", "CenterlineSectionMinSize", "CenterlineSectionMaxSize", "CenterlineSectionClosed",
          "CenterlineSectionBifurcation", "HealthyDiameter"})
        EXPECT_TRUE(data->GetPointData()->HasArray(name)) << name;
    const vtkIdType last = data->GetNumberOfPoints() - 1;
    EXPECT_NEAR(data->GetPoint(last)[0], 10, 1e-5);
    EXPECT_NEAR(data->GetPointData()->GetArray("Abscissas")->GetTuple1(last), 10, 1e-3);
    EXPECT_NEAR(data->GetPointData()->GetArray("MaximumInscribedSphereRadius")->GetTuple1(0), 2 / std::hypot(1, 0.1),
                0.02);
    EXPECT_NEAR(data->GetPointData()->GetArray("CenterlineSectionArea")->GetTuple1(0), 4, 1e-6);
    EXPECT_EQ(data->GetPointData()->GetArray("BranchId")->GetTuple1(0), 0);
    EXPECT_EQ(data->GetPointData()->GetArray("BifurcationId")->GetTuple1(0), -1);
    EXPECT_TRUE(data->GetFieldData()->HasArray("SPACE"));
}

std::vector<Vec3> points_of(const fs::path& path, double unit) {
    std::vector<Vec3> points;
    if (path.extension() == ".vtp") {
        const auto data = read(path);
        for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k) {
            const double* x = data->GetPoint(k);
            points.push_back(unit * Vec3{x[0], x[1], x[2]});
        }
        return points;
    }
    std::ifstream file(path);   // legacy VTK as text
    std::string word;
    while (file >> word && word != "POINTS") {}
    std::size_t count = 0;
    file >> count >> word;
    for (Vec3 x; points.size() < count && file >> x.x >> x.y >> x.z;) points.push_back(unit * x);
    return points;
}

struct Published {
    const char *surface, *unit, *centreline;
    double metres;
    double share;   ///< of its points, within the larger of 0.5 mm and 5 % of the diameter from ours
};
void PrintTo(const Published& p, std::ostream* out) { *out << p.surface; }

class PublishedCentrelines : public ::testing::TestWithParam<Published> {};
/// Where theirs is farther off than the bar, ours is nearer to the middle: the sphere around theirs is smaller. Bifurcations
/// are left to each: there the ridge is flat, and spheres of the same size stand on both lines.
TEST_P(PublishedCentrelines, AreOursOrLessCentred) {
    const fs::path data = fs::path(PATENCY_SOURCE_DIR) / "../shared/data";
    if (!fs::exists(data)) GTEST_SKIP() << "no " << data;
    const Published& known = GetParam();
    const CheckedSurface checked = check_surface(read_surface((data / "vessels" / known.surface).string(), known.unit));
    std::vector<Opening> openings;
    for (const SurfaceOpening& o : find_openings(checked)) openings.push_back(o.opening);
    const SignedDistance distance = make_exact_distance(closed_at(checked.surface, checked.ends));
    const auto lines = find_centrelines(distance, openings);
    const auto theirs = points_of(data / "centerlines" / known.centreline, known.metres);
    ASSERT_GT(theirs.size(), 300u);
    double within = 0, explained = 0;
    for (const Vec3& x : theirs) {
        double off = std::numeric_limits<double>::infinity(), radius = 0;
        for (const Centreline& line : lines)
            for (std::size_t k = 1; k < line.points.size(); ++k) {
                const Vec3 a = line.points[k - 1].place, d = line.points[k].place - a;
                const double t = std::clamp(dot(x - a, d) / dot(d, d), 0.0, 1.0), r = norm(x - a - t * d);
                if (r < off) off = r, radius = (1 - t) * line.points[k - 1].radius + t * line.points[k].radius;
            }
        const bool is_near = off <= std::max(0.5e-3, 0.05 * 2 * radius);
        within += is_near / double(theirs.size());
        explained += (is_near || -distance.value(x) < 1.02 * radius) / double(theirs.size());
    }
    EXPECT_GT(within, known.share);
    EXPECT_GT(explained, 0.999);
}
INSTANTIATE_TEST_SUITE_P(
    Vessels, PublishedCentrelines,
    ::testing::Values(
        Published{"aortoiliac_vmtk_open_ends.stl", "mm", "aortoiliac_vmtk_centerline.vtp", 1e-3, 0.87},
        Published{"aortoiliac_simvascular_capped.vtp", "cm", "aortoiliac_simvascular_centerlines.vtp", 1e-2, 0.98},
        // Of a reconstruction from angiograms: not the middle of the published surface.
        Published{"coronary_phantom_7openings.stl", "mm", "coronary_phantom_centerlines.vtk", 1e-3, 0.73}));

}   // namespace
}   // namespace patency
