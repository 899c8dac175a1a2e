// SPDX-License-Identifier: Apache-2.0
// Every format read back, with marks and face ids; and files that are damaged in every way that was thought of.
#include "patency/io/surface_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

/// A tetrahedron of 4 mm, which every format below holds in mm.
const std::vector<Vec3> corners = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
const std::vector<Triangle> faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
constexpr double tetrahedron = 64e-9 / 6;   // m^3

std::string facets(const std::vector<Triangle>& triangles) {
    std::string text;
    for (const Triangle& t : triangles) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (std::uint32_t p : t) text += fmt::format("  vertex {} {} {}\n", corners[p].x, corners[p].y, corners[p].z);
        text += " endloop\nendfacet\n";
    }
    return text;
}
std::string stl_text() { return "solid lumen SPACE=RAS\n" + facets(faces) + "endsolid lumen\n"; }

std::string stl_binary(std::string header, std::uint32_t count = 4) {
    header.resize(80, ' ');
    header.append(reinterpret_cast<const char*>(&count), 4);
    for (const Triangle& t : faces) {
        float numbers[12] = {};
        for (int k = 0; k < 3; ++k) {
            const Vec3& x = corners[t[k]];
            numbers[3 + 3 * k] = float(x.x), numbers[4 + 3 * k] = float(x.y), numbers[5 + 3 * k] = float(x.z);
        }
        header.append(reinterpret_cast<const char*>(numbers), sizeof numbers).append(2, '\0');
    }
    return header;
}

const std::string ply_text =
    "ply\nformat ascii 1.0\ncomment SPACE=LPS\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\nproperty uchar red\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 9\n4 0 0 9\n0 4 0 9\n0 0 4 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string ply_binary(bool is_big_endian) {
    std::string bytes = fmt::format(
        "ply\r\nformat binary_{}_endian 1.0\r\nelement vertex 4\r\nproperty double x\r\nproperty double y\r\nproperty "
        "double z\r\n"
        "element face 4\r\nproperty list uchar uint vertex_index\r\nend_header\r\n",
        is_big_endian ? "big" : "little");
    const auto put_number = [&](auto number) {
        std::string raw(reinterpret_cast<const char*>(&number), sizeof number);
        if (is_big_endian) std::reverse(raw.begin(), raw.end());
        bytes += raw;
    };
    for (const Vec3& x : corners) put_number(x.x), put_number(x.y), put_number(x.z);
    for (const Triangle& t : faces) {
        bytes += '\3';
        for (std::uint32_t p : t) put_number(p);
    }
    return bytes;
}

const std::string obj =
    "# SPACE=RAS\no lumen\nv 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nvn 0 0 1\nf 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf -4 "
    "-1 -2\nf 2 3 4\n";

const std::string vtk_text =
    "# vtk DataFile Version 3.0\nlumen\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 4 0 0 0 4 0 0 0 4\n"
    "POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\nCELL_DATA 4\nSCALARS ModelFaceID int 1\nLOOKUP_TABLE "
    "default\n1 2 3 4\n";
const std::string vtk_strip =   // three faces as a strip, the fourth as a polygon
    "# vtk DataFile Version 3.0\nlumen\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 4 0 0 0 4 0 0 0 4\n"
    "POLYGONS 1 4\n3 0 1 3\nTRIANGLE_STRIPS 1 6\n5 1 0 2 3 1\n";

const std::string vtp =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
    "<FieldData><DataArray type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">76 80 83 "
    "0</DataArray></FieldData>"
    "<Piece NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"4\">"
    "<CellData><DataArray type=\"Int32\" Name=\"ModelFaceID\" format=\"ascii\">7 7 8 9</DataArray></CellData>"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 4 0 0 0 4 0 0 0 "
    "4</DataArray></Points>"
    "<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 2 1 0 1 3 0 3 2 1 2 3</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 6 9 "
    "12</DataArray></Polys></Piece></PolyData></VTKFile>\n";

std::string replaced(std::string text, std::string_view old, std::string_view with) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    return text.replace(at, old.size(), with);
}

class SurfaceFile : public ::testing::Test {
protected:
    Surface read(const std::string& name, const std::string& contents, std::string_view space = {}) {
        put(folder_ / name, contents);
        return read_surface(folder_ / name, "mm", space);
    }
    void expect_tetrahedron(const std::string& name, const std::string& contents, std::string_view space) {
        SCOPED_TRACE(name);
        const Surface surface = read(name, contents);
        EXPECT_EQ(surface.triangles.size(), 4u);
        EXPECT_NEAR(volume(surface), tetrahedron, 1e-9 * tetrahedron);
        EXPECT_EQ(surface.space, space);
    }
    template <class E>
    std::string refused(const std::string& name, const std::string& contents) {
        put(folder_ / name, contents);
        const std::string sentence = sentence_of<E>([&] { read_surface(folder_ / name, "mm"); });
        EXPECT_TRUE(has(sentence, name));
        return sentence;
    }
    ScratchFolder folder_;
};

TEST_F(SurfaceFile, EveryFormatGivesTheSameSurface) {
    expect_tetrahedron("a.stl", stl_text(), "RAS");
    expect_tetrahedron("b.stl", stl_binary("SPACE=LPS"), "LPS");
    expect_tetrahedron("c.ply", ply_text, "LPS");
    expect_tetrahedron("d.ply", ply_binary(false), "");
    expect_tetrahedron("e.ply", ply_binary(true), "");
    expect_tetrahedron("f.obj", obj, "RAS");
    expect_tetrahedron("g.vtk", vtk_text, "");
    expect_tetrahedron("h.vtk", vtk_strip, "");
    expect_tetrahedron("i.vtp", vtp, "LPS");
}

TEST_F(SurfaceFile, ContentsDecideWhateverTheNameSays) {
    expect_tetrahedron("binary.stl", stl_binary("solid with the word that text begins with"), "");
    expect_tetrahedron("vtp.stl", vtp, "LPS");
    expect_tetrahedron("stl.vtp", stl_binary(""), "");
    expect_tetrahedron("ply", ply_text, "LPS");
    expect_tetrahedron("UPPER.OBJ", obj, "RAS");
    expect_tetrahedron(
        "windows.stl",
        [] {
            std::string text;
            for (char c : stl_text()) text += c == '\n' ? "\r\n" : std::string(1, c);
            return text;
        }(),
        "RAS");
}

TEST_F(SurfaceFile, FaceIdsAreKept) {
    EXPECT_EQ(read("a.vtp", vtp).face_ids, (std::vector<std::int32_t>{7, 7, 8, 9}));
    EXPECT_EQ(read("a.vtk", vtk_text).face_ids, (std::vector<std::int32_t>{1, 2, 3, 4}));
    const std::string solids = "solid wall\n" + facets({faces[0], faces[1]}) + "endsolid wall\nsolid cap\n" +
                               facets({faces[2], faces[3]}) + "endsolid\n";
    EXPECT_EQ(read("a.stl", solids).face_ids, (std::vector<std::int32_t>{1, 1, 2, 2}));
    EXPECT_TRUE(read("b.stl", stl_text()).face_ids.empty());
    // A polygon of four corners has one id, its two triangles have it both.
    const std::string quad =
        replaced(replaced(replaced(vtp, "0 2 1 0 1 3 0 3 2 1 2 3", "0 1 2 3 0 3 2 1 2 3 "), "3 6 9 12", "4 7 10"),
                 "NumberOfPolys=\"4\"", "NumberOfPolys=\"3\"");
    EXPECT_EQ(read("quad.vtp", replaced(quad, "7 7 8 9", "7 8 9")).face_ids, (std::vector<std::int32_t>{7, 7, 8, 9}));
}

TEST_F(SurfaceFile, UnitAndSpaceAreTheCallers) {
    put(folder_ / "a.stl", stl_text());
    for (const auto& [unit, metres] : {std::pair("m", 4.0), {"cm", 0.04}, {"mm", 0.004}, {"um", 4e-6}})
        EXPECT_NEAR(bounds(read_surface(folder_ / "a.stl", unit)).high.x, metres, 1e-15);
    EXPECT_EQ(read_surface(folder_ / "a.stl", "mm", "LPS").space, "LPS");
    EXPECT_TRUE(has(sentence_of<UsageError>([&] { read_surface(folder_ / "a.stl", "inch"); }), "m, cm, mm or um"));
    EXPECT_THROW(read_surface(folder_ / "a.stl", ""), UsageError);
    EXPECT_THROW(read_surface(folder_ / "a.stl", "mm", "XYZ"), UsageError);
}

TEST_F(SurfaceFile, IsWrittenAndReadBack) {
    Surface surface = read("a.vtp", vtp);
    write_surface(folder_ / "b.vtp", surface);
    const Surface back = read_surface(folder_ / "b.vtp", "mm");
    EXPECT_EQ(back.triangles, surface.triangles);
    EXPECT_EQ(back.face_ids, surface.face_ids);
    EXPECT_EQ(back.space, "LPS");
    EXPECT_NEAR(volume(back), tetrahedron, 1e-6 * tetrahedron);
}

TEST_F(SurfaceFile, WhatIsNoFileIsRefused) {
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_surface(folder_ / "none.stl", "mm"); }), "none.stl"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_surface(folder_.path(), "mm"); }), "directory"));
    for (const char* name : {"e.stl", "e.vtp", "e.ply", "e.obj", "e.vtk", "e"})
        EXPECT_TRUE(has(refused<FileError>(name, ""), "empty"));
    EXPECT_TRUE(
        has(refused<FileError>("a.docx", "my thesis"), "STL, VTP, PLY, OBJ, legacy VTK, NIfTI, NRRD or MetaImage"));
    EXPECT_TRUE(
        has(refused<FileError>("a.vtp", "my thesis"), "STL, VTP, PLY, OBJ, legacy VTK, NIfTI, NRRD or MetaImage"));
    EXPECT_TRUE(
        has(refused<FileError>("a.vtp", replaced(vtp, "type=\"PolyData\"", "type=\"UnstructuredGrid\"")), "Extract"));
    EXPECT_TRUE(has(refused<FileError>("a.vtk", replaced(vtk_text, "POLYDATA", "UNSTRUCTURED_GRID")), "Extract"));
}

TEST_F(SurfaceFile, WhatIsCutShortIsRefused) {
    ::testing::internal::CaptureStderr();   // VTK has nothing to print
    ::testing::internal::CaptureStdout();
    for (const auto& [name, contents, least] :
         {std::tuple("a.stl", stl_text().substr(0, stl_text().find("endsolid") + 11), 20),
          {"b.stl", stl_binary("x"), 1},
          {"c.ply", ply_text, 5},
          {"d.ply", ply_binary(false), 6},
          {"g.vtk", vtk_text.substr(0, vtk_text.find("CELL_DATA")), 30},
          {"i.vtp", vtp, 90}}) {
        for (std::size_t length = std::size_t(least); length + 3 < contents.size();
             length += 1 + contents.size() / 60) {
            put(folder_ / name, contents.substr(0, length));
            try {
                read_surface(folder_ / name, "mm");
                ADD_FAILURE() << name << " of " << length << " bytes was read";
            } catch (const FileError& error) {
                EXPECT_TRUE(has(error.what(), name));
            } catch (const GeometryError& error) {
                EXPECT_TRUE(has(error.what(), "no triangle"));
            }
        }
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_TRUE(has(refused<FileError>("a.stl", stl_text().substr(0, stl_text().find("endfacet"))), "cut short"));
    EXPECT_TRUE(
        has(refused<FileError>("b.stl", stl_binary("x").substr(0, 200)), "4 triangles, but its length is that of 2"));
    EXPECT_TRUE(has(refused<FileError>("b.stl", stl_binary("solid x").substr(0, 200)), "4 triangles"));
    EXPECT_TRUE(has(refused<FileError>("b.stl", stl_binary("x", 4000000000u)), "4000000000 triangles"));
}

TEST_F(SurfaceFile, NumbersThatAreNoneAreRefused) {
    for (const char* bad : {"nan", "inf", "-inf", "1e999", "1e30"}) {
        EXPECT_TRUE(
            has(refused<FileError>("a.stl", replaced(stl_text(), "vertex 4 0 0", fmt::format("vertex {} 0 0", bad))),
                "no place in a body"));
        EXPECT_TRUE(
            has(refused<FileError>("a.ply", replaced(ply_text, "4 0 0 9", fmt::format("{} 0 0 9", bad))), "point 1"));
        EXPECT_TRUE(
            has(refused<FileError>("a.obj", replaced(obj, "v 4 0 0", fmt::format("v {} 0 0", bad))), "point 1"));
    }
    for (const char* bad : {"nan", "1e30"}) {
        refused<FileError>("a.vtp", replaced(vtp, "0 0 0 4 0 0", fmt::format("0 0 0 {} 0 0", bad)));
        refused<FileError>("a.vtk", replaced(vtk_text, "0 0 0 4 0 0", fmt::format("0 0 0 {} 0 0", bad)));
    }
    EXPECT_TRUE(has(refused<FileError>("a.stl", replaced(stl_text(), "vertex 4 0 0", "vertex 4 0")), "line "));
    EXPECT_TRUE(
        has(refused<FileError>("a.stl", replaced(stl_text(), "vertex 4 0 0", "vertex 4 0 0x")), "three numbers"));
    EXPECT_TRUE(has(refused<FileError>("a.stl", replaced(stl_text(), "vertex 4 0 0\n", "")), "3 vertices and has 2"));
    EXPECT_TRUE(
        has(refused<FileError>("a.stl", replaced(stl_text(), "facet normal", "fact normal")), "no place in an STL"));
}

TEST_F(SurfaceFile, IndicesOutOfRangeAreRefused) {
    EXPECT_TRUE(has(refused<FileError>("a.ply", replaced(ply_text, "3 1 2 3", "3 1 2 4")),
                    "names point 4, but there are 4 points"));
    EXPECT_TRUE(has(refused<FileError>("a.ply", replaced(ply_text, "3 1 2 3", "3 1 2 -1")), "triangle 3"));
    EXPECT_TRUE(has(refused<FileError>("a.obj", replaced(obj, "f 2 3 4", "f 2 3 5")), "names point 4"));
    for (const char* bad : {"f 2 3 0", "f 2 3 -9", "f 2 3 x", "f 2 3", "f 2 3 1.5", "f 2 3 nan"})
        refused<FileError>("a.obj", replaced(obj, "f 2 3 4", bad));
    EXPECT_TRUE(has(refused<FileError>("a.vtp", replaced(vtp, "1 2 3</", "1 2 99</")), "names point 99"));
    refused<FileError>("a.vtp", replaced(vtp, "1 2 3</", "1 2 -3</"));
    refused<FileError>("a.vtp", replaced(vtp, "3 6 9 12", "3 600 9 12"));
    refused<FileError>("a.vtp", replaced(vtp, "3 6 9 12", "3 -6 9 12"));
    refused<FileError>("a.vtp", replaced(vtp, "NumberOfPoints=\"4\"", "NumberOfPoints=\"40000000000\""));
    EXPECT_TRUE(has(refused<FileError>("a.vtk", replaced(vtk_text, "3 1 2 3", "3 1 2 9")), "names point 9"));
    for (const char* bad : {"9 1 2 3", "-3 1 2 3", "2000000000 1 2 3", "x 1 2 3"})
        EXPECT_TRUE(has(refused<FileError>("a.vtk", replaced(vtk_text, "3 1 2 3", bad)), "POLYGONS"));
    for (const char* bad : {"POINTS -4 ", "POINTS 4000000000000 ", "POINTS x "})
        EXPECT_TRUE(has(refused<FileError>("a.vtk", replaced(vtk_text, "POINTS 4 ", bad)), "POINTS"));
}

TEST_F(SurfaceFile, CountsOfNothingTakeNeitherTimeNorMemory) {
    for (const char* element : {"vertex", "face", "thing"})
        refused<GeometryError>("a.ply", fmt::format("ply\nformat ascii 1.0\nelement {} 1e300\nend_header\n", element));
    put(folder_ / "b.ply", replaced(ply_text, "element vertex", "element thing 1e300\nelement vertex"));
    EXPECT_EQ(read_surface(folder_ / "b.ply", "mm").triangles.size(), 4u);
}

TEST_F(SurfaceFile, NoTrianglesAreAQuestionOfGeometry) {
    refused<GeometryError>("a.stl", "solid nothing\nendsolid nothing\n");
    refused<GeometryError>("b.stl", stl_binary("x", 0).substr(0, 84));
    refused<GeometryError>("a.obj", "v 0 0 0\nv 1 0 0\n");
    refused<GeometryError>("a.vtk", vtk_text.substr(0, vtk_text.find("POLYGONS")));
    refused<GeometryError>("a.ply", replaced(ply_text.substr(0, ply_text.find("3 0 2 1")), "face 4", "face 0"));
}

TEST_F(SurfaceFile, AFileThatCrashesVtkIsRefusedWithASentence) {
    // A table of ids shorter than it says: VTK 9.1 reads on behind it. Whether that crashes is chance, an answer is not.
    put(folder_ / "short.vtp", replaced(vtp, "7 7 8 9", "7"));
    try {
        const Surface surface = read_surface(folder_ / "short.vtp", "mm");
        EXPECT_EQ(surface.triangles.size(), 4u);
        EXPECT_TRUE(surface.face_ids.empty());   // they cannot be known
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find("short.vtp"), std::string::npos);
    }
}

TEST_F(SurfaceFile, MutatedFilesEndInASentence) {
    ::testing::internal::CaptureStderr();
    std::mt19937 random(1);
    int read_well = 0;
    for (const auto& [name, contents] : {std::pair("a.stl", stl_text()),
                                         {"b.stl", stl_binary("x")},
                                         {"c.ply", ply_text},
                                         {"d.ply", ply_binary(false)},
                                         {"e.vtp", vtp},
                                         {"f.obj", obj},
                                         {"g.vtk", vtk_text},
                                         {"h.vtk", vtk_strip}})
        for (int round = 0; round < 60; ++round) {
            std::string mutated = contents;
            for (int k = 0; k < 1 + round % 4; ++k) {
                const std::size_t at = random() % mutated.size();
                if (round % 3 == 0) mutated[at] = char(random());
                if (round % 3 == 1) mutated.erase(at, 1 + random() % 9);
                if (round % 3 == 2) mutated.insert(at, mutated.substr(random() % mutated.size(), random() % 12));
            }
            put(folder_ / name, mutated);
            try {
                read_surface(folder_ / name, "mm");
                ++read_well;
            } catch (const FileError& error) {   // what is wrong with the file, not VTK's state
                EXPECT_EQ(std::string(error.what()).find("FORWARD_DIRECTION"), std::string::npos) << error.what();
            } catch (const GeometryError&) {}
        }
    EXPECT_GT(read_well, 10);   // a changed digit is no damage
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}   // namespace
}   // namespace patency
