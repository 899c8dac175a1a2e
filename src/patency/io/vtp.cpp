// SPDX-License-Identifier: Apache-2.0
#include "patency/io/vtp.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"

namespace patency {
namespace {

constexpr double mm_per_m = 1e3;

/// Where svMultiPhysics and VaMPy have a name for it, users' ParaView macros expect that name.
constexpr std::pair<std::string_view, std::string_view> peer_names[] = {
    {"wall_shear_stress", "WSS"},
    {"time_averaged_wall_shear_stress", "TAWSS"},
    {"tawss", "TAWSS"},
    {"oscillatory_shear_index", "OSI"},
    {"osi", "OSI"},
    {"relative_residence_time", "RRT"},
    {"rrt", "RRT"},
    {"ecap", "ECAP"},
    {"von_mises_stress", "VonMises_stress"},
    {"ffr", "FFR"},
};

/// Rows of doubles in memory, or a selection of them.
struct Rows {
    std::span<const std::byte> bytes;
    int components = 1;
    std::span<const std::uint32_t> only{};

    std::size_t count() const {
        return only.empty() ? bytes.size() / (sizeof(double) * std::size_t(components)) : only.size();
    }
    double at(std::size_t row, int component) const {
        const std::size_t source = only.empty() ? row : only[row];
        double value;
        std::memcpy(&value, &bytes[(source * std::size_t(components) + std::size_t(component)) * sizeof value],
                    sizeof value);
        return value;
    }
};

struct Target {
    const std::filesystem::path& path;
    const VtpOptions& options;
};

/// scale * value + shift as 32-bit floats.
vtkNew<vtkFloatArray> make_floats(const std::string& name, const Rows& rows, const Target& target, double scale = 1,
                                  double shift = 0) {
    vtkNew<vtkFloatArray> array;
    array->SetName(name.c_str());
    array->SetNumberOfComponents(rows.components);
    array->SetNumberOfTuples(vtkIdType(rows.count()));
    float* out = array->GetPointer(0);
    for (std::size_t row = 0; row < rows.count(); ++row) {
        for (int c = 0; c < rows.components; ++c) {
            const double value = scale * rows.at(row, c) + shift;
            // The range is asked for in double: casting what does not fit a float is undefined.
            const bool fits = std::abs(value) <= double(std::numeric_limits<float>::max());
            if (!fits && target.options.non_finite == NonFinite::refuse)
                throw DivergedError(
                    fmt::format("{} of {} (point {}) would go into '{}': the computation has left the "
                                "realm of numbers.",
                                value, name, row, target.path.string()));
            const double limit = std::numeric_limits<double>::infinity();
            *out++ = fits || std::isnan(value) ? float(value) : float(std::copysign(limit, value));
        }
    }
    return array;
}

vtkNew<vtkIntArray> make_integers(const std::string& name, std::span<const std::byte> bytes,
                                  std::span<const std::uint32_t> only) {
    vtkNew<vtkIntArray> array;
    array->SetName(name.c_str());
    const std::size_t count = only.empty() ? bytes.size() / sizeof(std::int32_t) : only.size();
    array->SetNumberOfTuples(vtkIdType(count));
    int* out = array->GetPointer(0);
    for (std::size_t row = 0; row < count; ++row)
        std::memcpy(out + row, &bytes[(only.empty() ? row : only[row]) * sizeof(std::int32_t)], sizeof(std::int32_t));
    return array;
}

void add_text(vtkPolyData& data, const std::string& name, const std::string& text) {
    vtkNew<vtkStringArray> array;
    array->SetName(name.c_str());
    array->InsertNextValue(text);
    data.GetFieldData()->AddArray(array);
}

void add_unit(vtkPolyData& data, const std::string& name, const std::string& unit) {
    add_text(data, name + "_unit", unit);
}

void set_points(vtkPolyData& data, const Rows& places, const Target& target) {
    vtkNew<vtkPoints> points;
    points->SetData(make_floats("Points", places, target, mm_per_m));
    data.SetPoints(points);
    add_unit(data, "Coordinates", "mm");
}

/// A vertex cell per point: points without cells are invisible in ParaView.
void set_vertices(vtkPolyData& data) {
    vtkNew<vtkCellArray> cells;
    const vtkIdType count = data.GetNumberOfPoints();
    cells->AllocateExact(count, count);
    for (vtkIdType i = 0; i < count; ++i) cells->InsertNextCell(1, &i);
    data.SetVerts(cells);
}

template <class Indices>
void add_cell(vtkCellArray& cells, const Indices& indices) {
    cells.InsertNextCell(int(indices.size()));
    for (std::uint32_t i : indices) cells.InsertCellPoint(vtkIdType(i));
}

void write(vtkPolyData& data, const Target& target) {
    if (target.options.time) {
        vtkNew<vtkDoubleArray> time;
        time->SetName("TimeValue");   // ParaView shows it as the data set's time
        time->InsertNextValue(*target.options.time);
        data.GetFieldData()->AddArray(time);
        add_unit(data, "TimeValue", "s");
    }
    // Into memory first: then a full disk is noticed in one place only, and VTK has nothing to print.
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(&data);
    writer->WriteToOutputStringOn();
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetCompressorTypeToZLib();
    writer->SetCompressionLevel(1);    // 32-bit floats of a flow hardly shrink further, and 1 is quick
    writer->SetHeaderTypeToUInt64();   // 32-bit headers end at 4 GB per array
    if (data.GetNumberOfPoints() < std::numeric_limits<std::int32_t>::max()) writer->SetIdTypeToInt32();
    if (writer->Write() != 1)
        throw FileError(fmt::format("cannot write '{}': VTK could not encode it.", target.path.string()));
    write_file(target.path, writer->GetOutputString());
}

bool is_chosen(const FieldBase& field, const VtpOptions& options) {
    return field.name() != "position" &&
           (options.fields.empty() ||
            std::find(options.fields.begin(), options.fields.end(), field.name()) != options.fields.end());
}

}   // namespace

std::string vtk_name(std::string_view field_name) {
    for (const auto& [ours, theirs] : peer_names)
        if (field_name == ours) return std::string(theirs);
    std::string name;
    bool begins_word = true;
    for (char c : field_name) {
        if (c != '_') name += begins_word && c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
        begins_word = c == '_';
    }
    return name;
}

void write_particles(const std::filesystem::path& path, const ParticleSet& particles, const VtpOptions& options) {
    const Target target{path, options};
    const FieldBase* position = particles.find("position");
    if (!position || position->components() != 3) throw std::logic_error("these particles have no field 'position'");
    for (const std::string& name : options.fields)
        if (!particles.find(name)) throw std::logic_error("these particles have no field '" + name + "'");
    assert(std::all_of(options.only.begin(), options.only.end(), [&](auto i) { return i < particles.size(); }));

    vtkNew<vtkPolyData> data;
    set_points(*data, {std::as_const(*position).bytes(), 3, options.only}, target);
    set_vertices(*data);
    for (const FieldBase* field : particles.fields()) {
        if (!is_chosen(*field, options)) continue;
        const std::string name = vtk_name(field->name());
        if (field->is_integer())
            data->GetPointData()->AddArray(make_integers(name, field->bytes(), options.only));
        else
            data->GetPointData()->AddArray(make_floats(name, {field->bytes(), field->components(), options.only},
                                                       target, 1,
                                                       field->name() == "pressure" ? options.pressure_level : 0));
        add_unit(*data, name, field->unit());
    }
    write(*data, target);
}

void write_polydata(const std::filesystem::path& path, const PolyData& source, const VtpOptions& options) {
    const Target target{path, options};
    vtkNew<vtkPolyData> data;
    set_points(*data, {std::as_bytes(std::span(source.points)), 3}, target);
    if (source.lines.empty() && source.triangles.empty()) set_vertices(*data);
    vtkNew<vtkCellArray> lines, triangles;
    for (const auto& line : source.lines) add_cell(*lines, line);
    for (const auto& triangle : source.triangles) add_cell(*triangles, triangle);
    data->SetLines(lines);
    data->SetPolys(triangles);
    if (!source.space.empty()) add_text(*data, "SPACE", source.space);
    if (!source.face_ids.empty()) {
        assert(source.lines.empty() && source.face_ids.size() == source.triangles.size() && "one id per triangle");
        data->GetCellData()->AddArray(make_integers("ModelFaceID", std::as_bytes(std::span(source.face_ids)), {}));
    }
    for (const PointArray& array : source.arrays) {
        assert(array.values.size() == source.points.size() * std::size_t(array.components) && "one value per point");
        const std::string name = vtk_name(array.name);
        data->GetPointData()->AddArray(
            make_floats(name, {std::as_bytes(std::span(array.values)), array.components}, target));
        add_unit(*data, name, array.unit);
    }
    for (const IntegerArray& array : source.integers) {
        assert(array.values.size() == source.points.size() && "one value per point");
        data->GetPointData()->AddArray(make_integers(vtk_name(array.name), std::as_bytes(std::span(array.values)), {}));
    }
    write(*data, target);
}

}   // namespace patency
