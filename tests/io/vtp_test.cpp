// SPDX-License-Identifier: Apache-2.0
#include "patency/io/vtp.h"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>
#include <limits>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

struct Blood : ParticleSet {
    Field<Vec3> position{*this, "position", "m", Keep::state};
    Field<Vec3> velocity{*this, "velocity", "m/s", Keep::state};
    Field<double> pressure{*this, "pressure", "Pa", Keep::scratch};
    Field<Mat3> velocity_gradient{*this, "velocity_gradient", "1/s", Keep::scratch};
    Field<std::int32_t> opening{*this, "opening", "1", Keep::state};
};

void fill(Blood& blood, std::size_t count) {
    blood.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = double(i) / 7;
        blood.position[i] = {1e-3 * x, -2e-3 * x, 0.1};
        blood.velocity[i] = {std::sin(x), std::cos(x), x * x};
        blood.pressure[i] = 12000 + x;
        blood.velocity_gradient[i] = {{x, 1, 2}, {3, 4, 5}, {6, 7, -x}};
        blood.opening[i] = std::int32_t(i) - 2;
    }
}

vtkNew<vtkPolyData> read(const std::filesystem::path& path) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    vtkNew<vtkPolyData> data;
    data->ShallowCopy(reader->GetOutput());
    return data;
}

std::string text_in(vtkPolyData& data, const char* name) {
    const auto* array = vtkStringArray::SafeDownCast(data.GetFieldData()->GetAbstractArray(name));
    return array && array->GetNumberOfValues() == 1 ? std::string(const_cast<vtkStringArray*>(array)->GetValue(0))
                                                    : "missing";
}

TEST(Vtp, ParticlesReadBackAs32BitFloats) {
    const ScratchFolder folder;
    Blood blood;
    fill(blood, 1000);
    write_particles(folder / "f.vtp", blood, {.time = 0.1, .pressure_level = 100});
    const auto data = read(folder / "f.vtp");
    ASSERT_EQ(data->GetNumberOfPoints(), 1000);
    ASSERT_EQ(data->GetNumberOfVerts(), 1000);
    vtkPointData& arrays = *data->GetPointData();
    ASSERT_EQ(arrays.GetNumberOfArrays(), 4);
    for (const char* name : {"Velocity", "Pressure", "VelocityGradient", "Opening"})
        ASSERT_TRUE(arrays.GetArray(name)) << name;
    EXPECT_EQ(arrays.GetArray("Velocity")->GetDataType(), VTK_FLOAT);
    EXPECT_EQ(arrays.GetArray("Opening")->GetDataType(), VTK_INT);
    for (std::size_t i = 0; i < 1000; ++i) {
        const auto at = vtkIdType(i);
        double point[3];
        data->GetPoint(at, point);
        EXPECT_EQ(point[0], float(1e3 * blood.position[i].x));   // mm
        EXPECT_EQ(point[1], float(1e3 * blood.position[i].y));
        EXPECT_EQ(point[2], float(1e3 * 0.1));
        EXPECT_EQ(arrays.GetArray("Velocity")->GetComponent(at, 1), float(blood.velocity[i].y));
        EXPECT_EQ(arrays.GetArray("Pressure")->GetComponent(at, 0), float(blood.pressure[i] + 100));
        EXPECT_EQ(arrays.GetArray("VelocityGradient")->GetComponent(at, 5), 5);   // row y, column z
        EXPECT_EQ(arrays.GetArray("VelocityGradient")->GetComponent(at, 8), float(-blood.velocity_gradient[i].x.x));
        EXPECT_EQ(arrays.GetArray("Opening")->GetComponent(at, 0), double(i) - 2);
        vtkIdType count;
        const vtkIdType* cell;
        data->GetVerts()->GetCellAtId(at, count, cell);
        EXPECT_TRUE(count == 1 && cell[0] == at);
    }
}

TEST(Vtp, SaysTimeAndUnits) {
    const ScratchFolder folder;
    Blood blood;
    fill(blood, 3);
    write_particles(folder / "f.vtp", blood, {.time = 0.1});
    const auto data = read(folder / "f.vtp");
    EXPECT_EQ(data->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 0.1);
    EXPECT_EQ(text_in(*data, "Coordinates_unit"), "mm");
    EXPECT_EQ(text_in(*data, "Velocity_unit"), "m/s");
    EXPECT_EQ(text_in(*data, "Pressure_unit"), "Pa");
    EXPECT_EQ(text_in(*data, "Opening_unit"), "1");
}

TEST(Vtp, IsCompressedBinaryAndTheSameForTheSameParticles) {
    const ScratchFolder folder;
    Blood blood;
    fill(blood, 100);
    write_particles(folder / "a.vtp", blood);
    write_particles(folder / "b.vtp", blood);
    const std::string bytes = contents_of(folder / "a.vtp");
    EXPECT_EQ(bytes, contents_of(folder / "b.vtp"));
    EXPECT_TRUE(has(bytes, "vtkZLibDataCompressor"));
    EXPECT_TRUE(has(bytes, "<AppendedData encoding=\"raw\">"));
    EXPECT_TRUE(has(bytes, "header_type=\"UInt64\""));
}

TEST(Vtp, WritesChosenFieldsOfChosenParticles) {
    const ScratchFolder folder;
    Blood blood;
    fill(blood, 10);
    write_particles(folder / "f.vtp", blood, {.fields = {"opening", "velocity"}, .only = {7, 2}});
    const auto data = read(folder / "f.vtp");
    ASSERT_EQ(data->GetNumberOfPoints(), 2);
    ASSERT_EQ(data->GetPointData()->GetNumberOfArrays(), 2);
    EXPECT_EQ(data->GetPointData()->GetArray("Opening")->GetComponent(0, 0), 5);
    EXPECT_EQ(data->GetPointData()->GetArray("Opening")->GetComponent(1, 0), 0);
    EXPECT_EQ(data->GetPointData()->GetArray("Velocity")->GetComponent(0, 0), float(blood.velocity[7].x));
    EXPECT_EQ(data->GetPoint(1)[0], float(1e3 * blood.position[2].x));
    EXPECT_THROW(write_particles(folder / "f.vtp", blood, {.fields = {"speed"}}), std::logic_error);
    ParticleSet nowhere;
    EXPECT_THROW(write_particles(folder / "f.vtp", nowhere), std::logic_error);
}

TEST(Vtp, WritesNoParticlesAtAll) {
    const ScratchFolder folder;
    const Blood blood;
    write_particles(folder / "f.vtp", blood);
    EXPECT_EQ(read(folder / "f.vtp")->GetNumberOfPoints(), 0);
}

TEST(Vtp, RefusesWhatIsNotFiniteUnlessItIsTheOffenders) {
    const ScratchFolder folder;
    Blood blood;
    fill(blood, 10);
    for (double bad :
         {std::nan(""), -std::numeric_limits<double>::infinity(), 1e39}) {   // 1e39 > 3.4e38, the largest float
        blood.velocity[4].z = bad;
        EXPECT_TRUE(
            has(sentence_of<DivergedError>([&] { write_particles(folder / "f.vtp", blood); }), "Velocity (point 4)"));
        EXPECT_TRUE(folder.is_empty());
    }
    blood.velocity[3].x = std::nan("");
    write_particles(folder / "bad.vtp", blood, {.only = {3, 4}, .non_finite = NonFinite::allow});
    const auto data = read(folder / "bad.vtp");
    EXPECT_TRUE(std::isnan(data->GetPointData()->GetArray("Velocity")->GetComponent(0, 0)));
    EXPECT_TRUE(std::isinf(data->GetPointData()->GetArray("Velocity")->GetComponent(1, 2)));
    std::filesystem::remove(folder / "bad.vtp");
    fill(blood, 10);
    blood.position[1].x = std::nan("");
    EXPECT_TRUE(has(sentence_of<DivergedError>([&] { write_particles(folder / "f.vtp", blood); }), "Points"));
}

TEST(Vtp, LeavesThePreviousFileWhenTheDiskIsFull) {
    const ScratchFolder folder;
    Blood blood;
    fill(blood, 1000);
    put(folder / "f.vtp", "before");
    {
        const FileSizeLimit limit(1000);
        EXPECT_TRUE(has(sentence_of<FileError>([&] { write_particles(folder / "f.vtp", blood); }), "f.vtp"));
    }
    EXPECT_EQ(contents_of(folder / "f.vtp"), "before");
    EXPECT_THROW(write_particles(folder / "none/f.vtp", blood), FileError);
}

TEST(Vtp, WritesPointsLinesAndTriangles) {
    const ScratchFolder folder;
    PolyData data{
        .points = {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}},
        .arrays = {
            {.name = "wall_shear_stress", .unit = "Pa", .components = 3, .values = std::vector<double>(12, 2.5)}}};
    write_polydata(folder / "points.vtp", data);
    EXPECT_EQ(read(folder / "points.vtp")->GetNumberOfVerts(), 4);
    data.lines = {{0, 1, 2}, {2, 3}};
    data.triangles = {{0, 1, 3}};
    write_polydata(folder / "cells.vtp", data);
    const auto read_back = read(folder / "cells.vtp");
    EXPECT_EQ(read_back->GetNumberOfVerts(), 0);
    ASSERT_EQ(read_back->GetNumberOfLines(), 2);
    ASSERT_EQ(read_back->GetNumberOfPolys(), 1);
    vtkIdType count;
    const vtkIdType* line;
    read_back->GetLines()->GetCellAtId(1, count, line);
    EXPECT_TRUE(count == 2 && line[0] == 2 && line[1] == 3);
    EXPECT_EQ(read_back->GetPoint(1)[0], 1);
    EXPECT_EQ(read_back->GetPointData()->GetArray("WSS")->GetComponent(3, 2), 2.5);
    EXPECT_EQ(text_in(*read_back, "WSS_unit"), "Pa");
}

TEST(Vtp, NamesArraysAsPeersDo) {
    EXPECT_EQ(vtk_name("velocity"), "Velocity");
    EXPECT_EQ(vtk_name("pressure"), "Pressure");
    EXPECT_EQ(vtk_name("density"), "Density");
    EXPECT_EQ(vtk_name("wall_shear_stress"), "WSS");
    EXPECT_EQ(vtk_name("von_mises_stress"), "VonMises_stress");
    EXPECT_EQ(vtk_name("normal_direction"), "NormalDirection");
    EXPECT_EQ(vtk_name("position_0"), "Position0");
}

}   // namespace
}   // namespace patency
