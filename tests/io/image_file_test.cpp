// SPDX-License-Identifier: Apache-2.0
// The same ball of labels from every format, at the same place; and damaged files.
#include "patency/io/image_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "patency/base/errors.h"
#include "patency/io/surface_file.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

// A ball of 3 mm around (20, -10, 5) mm RAS, in voxels of 0.5 x 0.5 x 1 mm whose axes run left, forward and up (det < 0).
constexpr int nx = 20, ny = 18, nz = 12;
const Mat3 step{{-0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 1}};   // mm, RAS
const Vec3 origin{25.1, -14.2, -0.4};
const Vec3 middle{20, -10, 5};
constexpr double radius = 3;

template <class T>
std::string voxels(T label = 2) {
    std::string bytes;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                const Vec3 x = origin + step * Vec3{double(i), double(j), double(k)};
                const T value = norm(x - middle) < radius ? label : T(0);
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
    return bytes;
}

std::string packed(const std::string& bytes, bool as_gzip) {
    std::string out(bytes.size() + 1000, '\0');
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, as_gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

template <class T>
void set(std::string& header, std::size_t at, T value) {
    std::memcpy(header.data() + at, &value, sizeof value);
}

enum class Placement { sform, qform };
std::string nifti(Placement placement, std::int16_t type = 4, const std::string& numbers = voxels<std::int16_t>()) {
    std::string h(352, '\0');
    set(h, 0, std::int32_t(348));
    const std::int16_t dim[8] = {3, nx, ny, nz, 1, 1, 1, 1};
    for (std::size_t k = 0; k < 8; ++k) set(h, 40 + 2 * k, dim[k]);
    set(h, 70, type);
    const float pixdim[4] = {-1, 0.5f, 0.5f,
                             1};   // qfac -1: the rotation below turns by 180 degrees about y, z is flipped back
    for (std::size_t k = 0; k < 4; ++k) set(h, 76 + 4 * k, pixdim[k]);
    set(h, 108, 352.0f);
    set(h, 112, 1.0f);
    h[123] = 2;   // mm
    if (placement == Placement::sform) {
        set(h, 254, std::int16_t(1));
        const float rows[12] = {-0.5f, 0, 0, float(origin.x), 0, 0.5f, 0, float(origin.y), 0, 0, 1, float(origin.z)};
        for (std::size_t k = 0; k < 12; ++k) set(h, 280 + 4 * k, rows[k]);
    } else {
        set(h, 252, std::int16_t(1));
        set(h, 260, 1.0f);   // quaternion (0, 0, 1, 0)
        set(h, 268, float(origin.x)), set(h, 272, float(origin.y)), set(h, 276, float(origin.z));
    }
    h.replace(344, 4, "n+1\0", 4);
    return h + numbers;
}

std::string nrrd(const std::string& encoding, const std::string& data) {
    return fmt::format(
               "NRRD0004\n# made for a test\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: "
               "{} {} {}\n"
               "space directions: (0.5,0,0) (0,-0.5,0) (0,0,1)\nkinds: domain domain domain\nendian: little\nencoding: "
               "{}\n"
               "space origin: (-25.1,14.2,-0.4)\n\n",
               nx, ny, nz, encoding) +
           data;
}

std::string mha(const std::string& keys, const std::string& data, const std::string& file = "LOCAL") {
    return fmt::format(
               "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n{}TransformMatrix = "
               "1 0 0 0 -1 0 0 0 1\n"
               "Offset = -25.1 14.2 -0.4\nElementSpacing = 0.5 0.5 1\nDimSize = {} {} {}\nElementType = "
               "MET_UCHAR\nElementDataFile = {}\n",
               keys, nx, ny, nz, file) +
           data;
}

class ImageFile : public ::testing::Test {
protected:
    void expect_ball(const std::string& name, const std::string& contents, const std::string& space) {
        SCOPED_TRACE(name);
        put(folder_ / name, contents);
        const Surface s = read_surface(folder_ / name, "");
        EXPECT_EQ(s.space, space);
        Vec3 centre{};
        for (const Triangle& t : s.triangles) centre += norm(area_vector(s, t)) / area(s) * centroid(s, t);
        const double sign = space == "LPS" ? -1 : 1;
        EXPECT_NEAR(norm(centre - 1e-3 * Vec3{sign * middle.x, sign * middle.y, middle.z}), 0,
                    5e-5);   // a tenth of a voxel
        EXPECT_NEAR(volume(s) / (4 * std::numbers::pi / 3 * 27e-9), 1, 0.02);
    }
    template <class E>
    std::string refused(const std::string& name, const std::string& contents) {
        put(folder_ / name, contents);
        return sentence_of<E>([&] { read_surface(folder_ / name, ""); });
    }
    ScratchFolder folder_;
};

TEST_F(ImageFile, everyFormatHasTheBallInItsPlace) {
    expect_ball("sform.nii", nifti(Placement::sform), "RAS");
    expect_ball("qform.nii", nifti(Placement::qform), "RAS");
    expect_ball("packed.nii.gz", packed(nifti(Placement::sform), true), "RAS");
    expect_ball("raw.nrrd", nrrd("raw", voxels<std::uint8_t>()), "LPS");
    expect_ball("packed.nrrd", nrrd("gzip", packed(voxels<std::uint8_t>(), true)), "LPS");
    expect_ball("raw.mha", mha("", voxels<std::uint8_t>()), "LPS");
    expect_ball("packed.mha", mha("CompressedData = True\n", packed(voxels<std::uint8_t>(), false)), "LPS");
    put(folder_ / "ball.raw", voxels<std::uint8_t>());
    expect_ball("two_files.mhd", mha("", "", "ball.raw"), "LPS");
}

TEST_F(ImageFile, everyTypeOfNumberAndOrderOfBytes) {
    expect_ball("u8.nii", nifti(Placement::sform, 2, voxels<std::uint8_t>()), "RAS");
    expect_ball("i32.nii", nifti(Placement::sform, 8, voxels<std::int32_t>()), "RAS");
    expect_ball("f32.nii", nifti(Placement::sform, 16, voxels<float>()), "RAS");
    expect_ball("f64.nii", nifti(Placement::sform, 64, voxels<double>()), "RAS");
    expect_ball("i8.nii", nifti(Placement::sform, 256, voxels<std::int8_t>()), "RAS");
    expect_ball("u16.nii", nifti(Placement::sform, 512, voxels<std::uint16_t>()), "RAS");
    std::string big = nifti(Placement::sform);   // every field turned round
    const auto turn = [&](std::size_t at, std::size_t size) {
        std::reverse(big.begin() + std::ptrdiff_t(at), big.begin() + std::ptrdiff_t(at + size));
    };
    turn(0, 4);
    for (std::size_t k = 0; k < 8; ++k) turn(40 + 2 * k, 2), turn(76 + 4 * k, 4);
    turn(70, 2), turn(108, 4), turn(112, 4), turn(252, 2), turn(254, 2);
    for (std::size_t k = 0; k < 12; ++k) turn(280 + 4 * k, 4);
    for (std::size_t k = 352; k < big.size(); k += 2) turn(k, 2);
    expect_ball("big.nii", big, "RAS");
}

TEST_F(ImageFile, labelsSpaceAndUnitAreTheCallers) {
    std::string two = nifti(Placement::sform);
    set(two, 352, std::int16_t(7));
    EXPECT_TRUE(has(refused<GeometryError>("two.nii", two), "several labels: 2 and 7"));
    EXPECT_GT(read_surface(folder_ / "two.nii", "mm", "LPS", 2).triangles.size(), 100u);
    EXPECT_EQ(read_surface(folder_ / "two.nii", "mm", "LPS", 2).space, "LPS");
    EXPECT_TRUE(
        has(sentence_of<UsageError>([&] { read_surface(folder_ / "two.nii", "cm", "", 2); }), "knows its unit"));
}

TEST_F(ImageFile, refusesWhatItCannotBelieve) {
    const std::string good = nifti(Placement::sform);
    const auto changed = [&](auto change) {
        std::string bytes = good;
        change(bytes);
        return bytes;
    };
    EXPECT_TRUE(has(refused<FileError>("a.nii", good.substr(0, 3000)), "cut short"));
    EXPECT_TRUE(has(refused<FileError>("a.nii.gz", packed(good, true).substr(0, 200)), "cut short"));
    EXPECT_TRUE(has(refused<FileError>("a.nii", changed([](auto& b) { set(b, 42, std::int16_t(-5)); })), "no size"));
    EXPECT_TRUE(has(refused<FileError>("a.nii", changed([](auto& b) {
                                           set(b, 42, std::int16_t(3000)), set(b, 44, std::int16_t(3000));
                                       })),
                    "header promises"));
    EXPECT_TRUE(
        has(refused<FileError>(
                "a.nii.gz",
                packed(changed([](auto& b) { set(b, 42, std::int16_t(3000)), set(b, 44, std::int16_t(3000)); }), true)),
            "more numbers than it can hold"));
    EXPECT_TRUE(has(refused<FileError>("a.nii", changed([](auto& b) { set(b, 70, std::int16_t(128)); })), "type 128"));
    EXPECT_TRUE(has(
        refused<FileError>("a.nii", changed([](auto& b) { set(b, 40, std::int16_t(4)), set(b, 48, std::int16_t(3)); })),
        "more than one volume"));
    EXPECT_TRUE(
        has(refused<FileError>("a.nii", changed([](auto& b) { set(b, 280, std::nanf("")); })), "no place in a body"));
    EXPECT_TRUE(
        has(refused<FileError>("a.nii", nifti(Placement::sform, 16, std::string(voxels<float>().size(), '\xff'))),
            "no numbers"));
    EXPECT_TRUE(has(refused<FileError>("a.nrrd", nrrd("bzip2", "")), "encoding is 'bzip2'"));
    EXPECT_TRUE(has(refused<FileError>("a.mhd", mha("", "", "nothing.raw")), "nothing.raw"));
    EXPECT_TRUE(has(refused<FileError>("a.mha", mha("HeaderSize = -1\n", "")), "HeaderSize"));
}

TEST_F(ImageFile, damagedFilesEndInASentence) {
    std::mt19937 random(5);
    int read_well = 0;
    for (const auto& [name, contents] : {std::pair<std::string, std::string>{"a.nii", nifti(Placement::qform)},
                                         {"b.nii.gz", packed(nifti(Placement::sform), true)},
                                         {"c.nrrd", nrrd("gzip", packed(voxels<std::uint8_t>(), true))},
                                         {"d.mha", mha("", voxels<std::uint8_t>())}})
        for (int round = 0; round < 60; ++round) {
            std::string mutated = contents;
            for (int k = 0; k < 1 + round % 4; ++k) {
                const std::size_t at =
                    random() % std::min<std::size_t>(mutated.size(), 400);   // most of it in the header
                if (round % 3 == 0) mutated[at] = char(random());
                if (round % 3 == 1) mutated.erase(at, 1 + random() % 9);
                if (round % 3 == 2) mutated.insert(at, mutated.substr(random() % mutated.size(), random() % 12));
            }
            try {
                const Image image = parse_image(folder_ / name, mutated);
                read_well += !image.values.empty();
            } catch (const FileError&) {}
        }
    EXPECT_GT(read_well, 10);
}

// Published: a level set and the open surface that was made of its zero level, cut at three ends, in RAS (../shared/data/INDEX.md).
TEST(PublishedImage, levelSetGivesThePublishedSurface) {
    const fs::path data = fs::path(PATENCY_SOURCE_DIR) / "../shared/data";
    if (!fs::exists(data)) GTEST_SKIP() << "there is no " << data;
    const Surface mine = read_surface(data / "images/aortoiliac_vmtk_levelset.mha", "");
    const Surface published = read_surface(data / "vessels/aortoiliac_vmtk_open_ends.stl", "mm");
    EXPECT_EQ(mine.space, "LPS");
    // To the nearest point of a mesh of half a voxel, which is 0.3 mm or less from any place on it.
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < published.points.size(); k += 97, ++count) {
        const Vec3 x{-published.points[k].x, -published.points[k].y, published.points[k].z};
        double least = 1;
        Vec3 nearest{};
        for (const Triangle& t : mine.triangles) {
            const double d = norm(centroid(mine, t) - x);
            if (d < least)
                least = d, nearest = normalized(area_vector(mine, t)),
                nearest = dot(nearest, x - centroid(mine, t)) * nearest;
        }
        sum += dot(nearest, nearest);
    }
    EXPECT_LT(std::sqrt(sum / double(count)), 0.05e-3);   // voxels are 0.88 x 0.88 x 1.5 mm
}

}   // namespace
}   // namespace patency
