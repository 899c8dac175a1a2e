// SPDX-License-Identifier: Apache-2.0
// VTP and legacy VTK polydata, surfaces, centrelines and results, read by VTK from memory. What VTK would print goes into the error's sentence; counts that
// VTK believes without looking are checked before and after.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <limits>
#include <new>

#include "patency/base/text.h"
#include "patency/io/surface_formats.h"

namespace patency {

namespace {

/// Where VTK's messages go while it lives: here, and not to the terminal.
class QuietVtk {
public:
    QuietVtk() : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
        vtkOutputWindow::SetInstance(window_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    }
    ~QuietVtk() {
        vtkOutputWindow::SetInstance(before_);
        vtkLogger::SetStderrVerbosity(verbosity_);
    }
    QuietVtk(const QuietVtk&) = delete;
    QuietVtk& operator=(const QuietVtk&) = delete;

    const std::string& errors() const { return window_->errors; }

private:
    class Window : public vtkOutputWindow {
    public:
        static Window* New() { VTK_STANDARD_NEW_BODY(Window); }
        vtkTypeMacro(Window, vtkOutputWindow);
        void DisplayText(const char*) override {}
        void DisplayErrorText(const char* text) override { errors += text; }
        void DisplayWarningText(const char*) override {}
        void DisplayGenericWarningText(const char*) override {}
        void DisplayDebugText(const char*) override {}
        std::string errors;
    };
    vtkNew<Window> window_;
    vtkSmartPointer<vtkOutputWindow> before_;
    vtkLogger::Verbosity verbosity_;
};

/// The first complaint of VTK, without its own names and addresses; those after it are consequences, and lists of VTK's state.
std::string reason_of(const std::string& errors) {
    std::string_view text = errors;
    if (const std::size_t address = text.find("): "); address != text.npos) text = text.substr(address + 3);
    text = trimmed(text);
    return shortened(trimmed(text.substr(0, text.find('\n'))), 120);
}

std::vector<std::int64_t> values_of(vtkDataArray& array) {
    std::vector<std::int64_t> values(std::size_t(array.GetNumberOfValues()));
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::int64_t(array.GetComponent(vtkIdType(k), 0));
    return values;
}

/// The corners of every cell; refuses a table that points beyond itself.
std::vector<std::vector<std::uint32_t>> cells_of(const SurfaceBytes& file, vtkCellArray& cells) {
    std::vector<std::vector<std::uint32_t>> result;
    const auto offsets = values_of(*cells.GetOffsetsArray()), corners = values_of(*cells.GetConnectivityArray());
    for (std::size_t k = 0; k + 1 < offsets.size(); ++k) {
        if (offsets[k] < 0 || offsets[k] > offsets[k + 1] || offsets[k + 1] > std::int64_t(corners.size()))
            refuse_file(
                file,
                fmt::format(
                    "polygon {} has a place in the table of points that does not exist. Export the surface again.", k));
        auto& cell = result.emplace_back();
        for (std::int64_t c = offsets[k]; c < offsets[k + 1]; ++c) {
            const std::int64_t point = corners[std::size_t(c)];
            cell.push_back(point >= 0 && point < std::int64_t(UINT32_MAX)
                               ? std::uint32_t(point)
                               : UINT32_MAX);   // the check of indices refuses it
        }
    }
    return result;
}

std::vector<Vec3> points_of(vtkPolyData& data) {
    std::vector<Vec3> points;
    for (vtkIdType k = 0; k < data.GetNumberOfPoints(); ++k) {
        double x[3];
        data.GetPoint(k, x);
        points.push_back({x[0], x[1], x[2]});
    }
    return points;
}

std::string space_of(vtkPolyData& data) {
    auto* space = vtkStringArray::SafeDownCast(data.GetFieldData()->GetAbstractArray("SPACE"));
    return space && space->GetNumberOfValues() > 0 ? space_mark("SPACE=" + space->GetValue(0)) : "";
}

Surface surface_of(const SurfaceBytes& file, vtkPolyData& data) {
    Surface surface{.points = points_of(data), .space = space_of(data)};
    const auto polygons = cells_of(file, *data.GetPolys()), strips = cells_of(file, *data.GetStrips());
    vtkDataArray* ids = data.GetCellData()->GetArray("ModelFaceID");
    const vtkIdType first = data.GetNumberOfVerts() + data.GetNumberOfLines();   // of the polygons among the cells
    if (ids && ids->GetNumberOfTuples() < first + vtkIdType(polygons.size() + strips.size())) ids = nullptr;
    const auto give_id = [&](std::size_t cell) {
        if (ids)
            surface.face_ids.resize(surface.triangles.size(),
                                    std::int32_t(std::clamp(ids->GetComponent(first + vtkIdType(cell), 0), -2e9, 2e9)));
    };
    for (std::size_t k = 0; k < polygons.size(); ++k) {
        add_polygon(surface, polygons[k]);
        give_id(k);
    }
    for (std::size_t k = 0; k < strips.size(); ++k) {
        for (std::size_t c = 2; c < strips[k].size(); ++c) {   // every second triangle of a strip runs backward
            const std::uint32_t a = strips[k][c - 2], b = strips[k][c - 1];
            surface.triangles.push_back({c % 2 ? b : a, c % 2 ? a : b, strips[k][c]});
        }
        give_id(polygons.size() + k);
    }
    return surface;
}

CentrelineData centrelines_of(const SurfaceBytes& file, vtkPolyData& data) {
    CentrelineData lines{.points = points_of(data), .radii = {}, .edges = {}, .space = space_of(data)};
    vtkDataArray* radii = nullptr;
    for (const char* name : {"MaximumInscribedSphereRadius", "Radius", "radius", "Radii", "radii"})
        if (!radii) radii = data.GetPointData()->GetArray(name);
    if (!radii || radii->GetNumberOfTuples() < vtkIdType(lines.points.size()))
        refuse_file(
            file,
            "its points have no radii: a point array MaximumInscribedSphereRadius, Radius or radii is needed. Compute "
            "the centrelines with radii.");
    for (std::size_t k = 0; k < lines.points.size(); ++k) lines.radii.push_back(radii->GetComponent(vtkIdType(k), 0));
    for (const auto& line : cells_of(file, *data.GetLines()))
        for (std::size_t k = 0; k < line.size(); ++k) {
            if (line[k] >= lines.points.size())
                refuse_file(file, fmt::format("a line names a point beyond the last of {}. Export it again.",
                                              lines.points.size()));
            if (k > 0) lines.edges.push_back({line[k - 1], line[k]});
        }
    return lines;
}

std::string text_of(vtkPolyData& data, const std::string& name) {
    auto* text = vtkStringArray::SafeDownCast(data.GetFieldData()->GetAbstractArray(name.c_str()));
    return text && text->GetNumberOfValues() > 0 ? std::string(text->GetValue(0)) : "";
}

PolyData polydata_of(const SurfaceBytes& file, vtkPolyData& data) {
    PolyData result{.points = points_of(data), .lines = cells_of(file, *data.GetLines()), .space = space_of(data)};
    for (const auto& cell : cells_of(file, *data.GetPolys()))
        for (std::size_t c = 2; c < cell.size(); ++c) result.triangles.push_back({cell[0], cell[c - 1], cell[c]});
    const auto expect_point = [&](std::uint32_t point) {
        if (point >= result.points.size())
            refuse_file(file, fmt::format("a cell names a point beyond the last of {}. Export it again.",
                                          result.points.size()));
    };
    for (const auto& line : result.lines)
        for (std::uint32_t point : line) expect_point(point);
    for (const auto& triangle : result.triangles)
        for (std::uint32_t point : triangle) expect_point(point);
    for (int k = 0; k < data.GetPointData()->GetNumberOfArrays(); ++k) {
        vtkDataArray* array = data.GetPointData()->GetArray(k);
        if (!array || !array->GetName() || array->GetNumberOfTuples() != data.GetNumberOfPoints()) continue;
        PointArray& copy = result.arrays.emplace_back(PointArray{array->GetName(),
                                                                 text_of(data, std::string(array->GetName()) + "_unit"),
                                                                 array->GetNumberOfComponents(),
                                                                 {}});
        copy.values.reserve(std::size_t(array->GetNumberOfValues()));
        for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
            for (int c = 0; c < copy.components; ++c) copy.values.push_back(array->GetComponent(i, c));
    }
    return result;
}

enum class Trial { passed, crashed, too_large };

/// How a child process fares with `attempt`: VTK 9.1 reads beyond its arrays in some damaged files, whatever is checked
/// before, and a crash must be a sentence. It has the time and the memory that a sound file of `size` bytes needs many
/// times over: damaged counts ask for more.
template <class Attempt>
Trial try_in_child(std::size_t size, Attempt attempt) {
    const rlim_t seconds = 5 + size / 5'000'000;                    // VTK reads 100 MB/s
    const rlim_t memory = (rlim_t(2) << 30) + 100 * rlim_t(size);   // of addresses: libraries and threads included
    constexpr int out_of_memory = 3;
    const pid_t child = ::fork();
    if (child < 0) return Trial::passed;   // no process to be had: then without the trial
    if (child == 0) {
        for (const int crash : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE})
            std::signal(crash, SIG_DFL);   // no report of it: the sentence is the parent's
        const rlimit time_limit{seconds, seconds};
        [[maybe_unused]] const rlimit memory_limit{memory, memory};
        ::setrlimit(RLIMIT_CPU, &time_limit);
#ifndef __SANITIZE_ADDRESS__   // whose map of the memory takes terabytes of addresses
        ::setrlimit(RLIMIT_AS, &memory_limit);
#endif
        try {
            attempt();
        } catch (const std::bad_alloc&) {
            ::_exit(out_of_memory);
        } catch (...) {   // what VTK says of it, the parent hears itself
        }
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    if (!WIFEXITED(status)) return Trial::crashed;
    if (WEXITSTATUS(status) == out_of_memory) return Trial::too_large;
    return WEXITSTATUS(status) == 0 ? Trial::passed
                                    : Trial::crashed;   // a library, or a sanitizer, may end the process by itself
}

/// `read` makes VTK read and returns its output; `convert` takes what is needed of it.
template <class Read, class Convert>
auto read_with_vtk(const SurfaceBytes& file, Read read, Convert convert) {
    const QuietVtk quiet;
    const char* too_large = "its counts need more memory than there is: it is damaged. Copy or export it again.";
    const Trial trial = try_in_child(file.bytes.size(), read);
    if (trial == Trial::crashed)
        refuse_file(file,
                    "it is damaged: VTK's reader crashes on it or does not come to an end. Copy or export it again.");
    if (trial == Trial::too_large) refuse_file(file, too_large);
    try {
        const vtkSmartPointer<vtkPolyData> data = read();
        if (!quiet.errors().empty() || !data)
            refuse_file(file, fmt::format("it is damaged or cut short (VTK: {}). Copy or export it again.",
                                          reason_of(quiet.errors())));
        return convert(file, *data);
    } catch (const std::bad_alloc&) {
        refuse_file(file, too_large);
    }
}

/// Refuses counts, given as KEY="N", that no compression packs into a file of that length.
void expect_possible_counts(const SurfaceBytes& file) {
    constexpr double densest = 1100;   // zlib packs 1032 bytes into one at best
    for (const std::string_view key : {"NumberOfPoints=\"", "NumberOfPolys=\"", "NumberOfStrips=\"", "NumberOfLines=\"",
                                       "NumberOfVerts=\"", "NumberOfTuples=\"", "NumberOfComponents=\""})
        for (std::size_t at = file.bytes.find(key); at != file.bytes.npos; at = file.bytes.find(key, at + 1)) {
            const std::string_view rest = file.bytes.substr(at + key.size(), 40);
            const auto count = read_number(trimmed(rest.substr(0, rest.find('"'))));
            if (!count || !(*count >= 0) || *count > densest * double(file.bytes.size()))
                refuse_file(file, fmt::format("it says {}{}, which cannot be. Export the surface again.", key,
                                              shortened(rest.substr(0, rest.find('"')))));
        }
}

/// Refuses legacy tables of cells (before version 5: a count, then so many indices, again and again) that lead beyond
/// their end, which VTK would follow.
void expect_sound_tables(const SurfaceBytes& file) {
    Lines lines(file.bytes);
    const std::string_view version = lines.next().value_or("").substr(0, 40);
    const std::string_view title = lines.next().value_or("");
    const std::string_view encoding = trimmed(lines.next().value_or(""));
    const bool is_text = encoding == "ASCII";
    // VTK goes on without a stream after a header that it does not like.
    if (title.size() > 255 || (!is_text && encoding != "BINARY") ||
        !trimmed(lines.next().value_or("")).starts_with("DATASET POLYDATA"))
        refuse_file(file,
                    "its header is damaged: a title, ASCII or BINARY, and DATASET POLYDATA are due. Export it again.");
    const bool has_counts = version.find("Version 5") == version.npos;
    const auto refuse = [&](std::string_view section) {
        refuse_file(file, fmt::format("its section {} is damaged or cut short. Copy or export it again.", section));
    };
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string_view section = next_word(rest);
        const bool is_cells =
            section == "POLYGONS" || section == "TRIANGLE_STRIPS" || section == "LINES" || section == "VERTICES";
        if (!is_cells && section != "POINTS" && section != "CELL_DATA" && section != "POINT_DATA") continue;
        const auto count = read_number(next_word(rest));
        if (!count || !(*count >= 0 && *count <= double(file.bytes.size()))) refuse(section);
        if (!is_cells) continue;
        const auto size = read_number(next_word(rest));
        if (!size || !(*size >= 0 && *size <= double(file.bytes.size()))) refuse(section);
        if (!has_counts) continue;
        std::string_view table = lines.rest();
        double used = 0;
        for (double cell = 0; cell < *count; ++cell) {
            double corners = -1;
            if (is_text) {
                corners = read_number(next_word(table)).value_or(-1);
                for (double k = 0; k < corners; ++k)
                    if (!read_number(next_word(table))) refuse(section);   // VTK goes on without a stream here too
            } else if (table.size() >= 4) {
                unsigned char b[4];
                std::memcpy(b, table.data(), 4);
                corners = double((std::uint32_t(b[0]) << 24) | (std::uint32_t(b[1]) << 16) |
                                 (std::uint32_t(b[2]) << 8) | b[3]);
                if (table.size() < 4 * (1 + std::size_t(corners))) refuse(section);
                table.remove_prefix(4 * (1 + std::size_t(corners)));
            }
            if (corners < 0 || corners != std::uint32_t(corners)) refuse(section);
            used += 1 + corners;
        }
        if (used != *size) refuse(section);
    }
}

template <class Convert>
auto read_vtp(const SurfaceBytes& file, Convert convert) {
    const std::string_view start = file.bytes.substr(0, 4096);
    if (start.find("type=\"PolyData\"") == start.npos)
        refuse_file(file,
                    "it is a VTK file of another type than PolyData. Extract the surface (in ParaView: Extract "
                    "Surface) and save it as VTP.");
    expect_possible_counts(file);
    return read_with_vtk(
        file,
        [&] {
            vtkNew<vtkXMLPolyDataReader> reader;
            reader->ReadFromInputStringOn();
            reader->SetInputString(std::string(file.bytes));
            reader->Update();
            return vtkSmartPointer<vtkPolyData>(reader->GetErrorCode() == 0 ? reader->GetOutput() : nullptr);
        },
        convert);
}

template <class Convert>
auto read_legacy_vtk(const SurfaceBytes& file, Convert convert) {
    if (file.bytes.find("DATASET POLYDATA") == file.bytes.npos)
        refuse_file(file,
                    "it is a VTK file of another type than POLYDATA. Extract the surface (in ParaView: Extract "
                    "Surface) and save it as VTP.");
    if (file.bytes.size() > std::size_t(std::numeric_limits<int>::max()))   // VTK counts its bytes in int
        refuse_file(file, "it has more than 2 GB. Save it as VTP.");
    expect_sound_tables(file);
    return read_with_vtk(
        file,
        [&] {
            vtkNew<vtkPolyDataReader> reader;
            reader->ReadFromInputStringOn();
            reader->SetBinaryInputString(file.bytes.data(), int(file.bytes.size()));
            reader->ReadAllFieldsOn();
            reader->Update();
            return vtkSmartPointer<vtkPolyData>(reader->GetErrorCode() == 0 ? reader->GetOutput() : nullptr);
        },
        convert);
}

}   // namespace

Surface parse_vtp(const SurfaceBytes& file) { return read_vtp(file, surface_of); }

PolyData parse_vtp_polydata(const SurfaceBytes& file) { return read_vtp(file, polydata_of); }

Surface parse_legacy_vtk(const SurfaceBytes& file) { return read_legacy_vtk(file, surface_of); }

CentrelineData parse_vtk_lines(const SurfaceBytes& file) {
    return file.bytes.starts_with("# vtk") ? read_legacy_vtk(file, centrelines_of) : read_vtp(file, centrelines_of);
}

}   // namespace patency
