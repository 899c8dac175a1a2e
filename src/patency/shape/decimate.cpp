// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/decimate.h"

#include <vtkCellArray.h>
#include <vtkDecimatePro.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <limits>

namespace patency {

namespace {

constexpr char number_name[] = "number";

vtkSmartPointer<vtkPolyData> to_vtk(std::span<const Vec3> points, std::span<const Triangle> triangles) {
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    vtkNew<vtkIntArray> numbers;
    numbers->SetName(number_name);
    for (std::size_t k = 0; k < points.size(); ++k) {
        places->InsertNextPoint(points[k].x, points[k].y, points[k].z);
        numbers->InsertNextValue(int(k));
    }
    vtkNew<vtkCellArray> cells;
    for (const Triangle& t : triangles) {
        const vtkIdType corners[3] = {vtkIdType(t[0]), vtkIdType(t[1]), vtkIdType(t[2])};
        cells->InsertNextCell(3, corners);
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(places);
    data->SetPolys(cells);
    data->GetPointData()->AddArray(numbers);
    return data;
}

/// Without the points that no triangle has.
Decimated tidied(std::span<const std::uint32_t> numbers, std::span<const Triangle> triangles) {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renamed(numbers.size(), none);
    Decimated result;
    for (Triangle t : triangles) {
        for (std::uint32_t& corner : t) {
            std::uint32_t& name = renamed[corner];
            if (name == none) {
                name = std::uint32_t(result.kept.size());
                result.kept.push_back(numbers[corner]);
            }
            corner = name;
        }
        result.triangles.push_back(t);
    }
    return result;
}

}   // namespace

Decimated decimate(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t most) {
    std::vector<std::uint32_t> numbers(points.size());
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = std::uint32_t(k);
    if (triangles.size() <= most) return tidied(numbers, triangles);
    vtkNew<vtkDecimatePro> filter;
    const auto data = to_vtk(points, triangles);
    filter->SetInputData(data);
    filter->SetTargetReduction(1 - double(most) / double(triangles.size()));
    filter->PreserveTopologyOn();
    filter->SplittingOff();
    filter->BoundaryVertexDeletionOn();
    filter->Update();
    vtkPolyData& out = *filter->GetOutput();
    vtkDataArray& kept = *out.GetPointData()->GetArray(number_name);
    for (vtkIdType k = 0; k < out.GetNumberOfPoints(); ++k)
        numbers[std::size_t(k)] = std::uint32_t(kept.GetComponent(k, 0));
    numbers.resize(std::size_t(out.GetNumberOfPoints()));
    std::vector<Triangle> left;
    vtkNew<vtkIdList> corners;
    for (vtkCellArray& cells = *out.GetPolys(); left.size() < std::size_t(cells.GetNumberOfCells());) {
        cells.GetCellAtId(vtkIdType(left.size()), corners);
        left.push_back(
            {std::uint32_t(corners->GetId(0)), std::uint32_t(corners->GetId(1)), std::uint32_t(corners->GetId(2))});
    }
    return tidied(numbers, left);
}

}   // namespace patency
