// SPDX-License-Identifier: Apache-2.0
#include "patency/io/checkpoint.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"
#include "patency/io/checkpoint_block.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

struct Blood : ParticleSet {
    Field<Vec3> position{*this, "position", "m", Keep::state};
    Field<double> density{*this, "density", "kg/m^3", Keep::state};
    Field<Mat3> gradient{*this, "gradient", "1/s", Keep::state};
    Field<std::int32_t> origin{*this, "origin", "1", Keep::state};
    Field<double> pressure{*this, "pressure", "Pa", Keep::scratch};
};

const CheckpointOrigin origin{"d1", "b1", {{"lumen of patient 3.stl", "s1"}, {"inflow.csv", "c1"}}};

/// Any finite double: every bit is drawn, so denormals, tiny and huge numbers and both zeros occur.
double random_double(std::mt19937_64& random) {
    for (;;)
        if (const double value = std::bit_cast<double>(random()); std::isfinite(value)) return value;
}

void fill(Blood& blood, std::size_t count) {
    std::mt19937_64 random(count);
    blood.resize(count);
    for (FieldBase* field : blood.fields()) {
        if (field->is_integer()) continue;
        const std::span<std::byte> bytes = field->bytes();
        for (std::size_t i = 0; i < bytes.size(); i += sizeof(double)) {
            const double value = random_double(random);
            std::memcpy(&bytes[i], &value, sizeof value);
        }
    }
    for (std::int32_t& o : blood.origin) o = std::int32_t(random());
    if (count < 4) return;
    blood.density[0] = -0.0;
    blood.density[1] = std::numeric_limits<double>::denorm_min();
    blood.density[2] = -std::numeric_limits<double>::max();
    blood.origin[3] = std::numeric_limits<std::int32_t>::min();
}

bool same_bits(const FieldBase& a, const FieldBase& b) {
    return a.bytes().size() == b.bytes().size() &&
           (a.bytes().empty() || std::memcmp(a.bytes().data(), b.bytes().data(), a.bytes().size()) == 0);
}

/// A checkpoint of ten particles and a time.
std::filesystem::path write_one(const ScratchFolder& folder, std::string_view name = "flow.h5") {
    Blood blood;
    fill(blood, 10);
    CheckpointWriter writer(folder / name, origin);
    writer.write(blood, "fluid");
    writer.write("time", 0.25);
    writer.finish();
    return folder / name;
}

TEST(Checkpoint, ReadsParticlesBitForBit) {
    const ScratchFolder folder;
    for (std::size_t count : {0, 1, 1000}) {
        Blood written;
        fill(written, count);
        CheckpointWriter writer(folder / "c.h5", origin);
        writer.write(written, "fluid");
        writer.finish();

        Blood read;
        fill(read, 17);
        CheckpointReader(folder / "c.h5").read(read, "fluid");
        ASSERT_EQ(read.size(), count);
        for (const FieldBase* field : written.fields()) {
            if (field->keep() != Keep::state) continue;
            EXPECT_TRUE(same_bits(*field, *read.find(field->name()))) << field->name();
        }
        EXPECT_EQ(read.pressure.size(), count);   // scratch is resized and nothing else
    }
}

TEST(Checkpoint, ReadsValuesBitForBit) {
    const ScratchFolder folder;
    const double signalling = std::bit_cast<double>(std::uint64_t{0x7ff0000000000001});
    const std::vector<double> numbers = {-0.0, 5e-324, signalling, -std::numeric_limits<double>::infinity()};
    const std::vector<std::int64_t> integers = {std::numeric_limits<std::int64_t>::min(), -1, 0, 1};
    const std::vector<std::byte> bytes = {std::byte{0}, std::byte{255}};
    const std::string text("line\n\0\xc3\xa4 end\0", 13);
    CheckpointWriter writer(folder / "c.h5", origin);
    writer.write("ends/outlet_1/pressure", signalling);
    writer.write("ends/outlet_1/steps", std::int64_t{-7});
    writer.write("numbers", numbers);
    writer.write("integers", integers);
    writer.write("bytes", bytes);
    writer.write("text", text);
    writer.write("empty/text", std::string());
    writer.write("empty/numbers", std::vector<double>());
    writer.finish();

    const CheckpointReader reader(folder / "c.h5");
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    EXPECT_EQ(bits(reader.read<double>("ends/outlet_1/pressure")), bits(signalling));
    EXPECT_EQ(reader.read<std::int64_t>("ends/outlet_1/steps"), -7);
    const auto read_numbers = reader.read<std::vector<double>>("numbers");
    ASSERT_EQ(read_numbers.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(bits(read_numbers[i]), bits(numbers[i])) << i;
    EXPECT_EQ(reader.read<std::vector<std::int64_t>>("integers"), integers);
    EXPECT_EQ(reader.read<std::vector<std::byte>>("bytes"), bytes);
    EXPECT_EQ(reader.read<std::string>("text"), text);
    EXPECT_EQ(reader.read<std::string>("empty/text"), "");
    EXPECT_TRUE(reader.read<std::vector<double>>("empty/numbers").empty());
    EXPECT_TRUE(reader.contains("ends/outlet_1/steps"));
    EXPECT_FALSE(reader.contains("ends/outlet_2/steps"));
}

TEST(Checkpoint, IsTheSameFileForTheSameState) {
    const ScratchFolder folder;
    const std::string first = contents_of(write_one(folder, "a.h5"));
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));   // dates in HDF5 files count seconds
    EXPECT_EQ(first, contents_of(write_one(folder, "b.h5")));
}

TEST(Checkpoint, IsAnHdf5File) {
    const ScratchFolder folder;
    const std::filesystem::path path = write_one(folder);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    const hid_t dataset = H5Dopen2(file, "values/time", H5P_DEFAULT);
    double time = 0;
    EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &time), 0);
    EXPECT_EQ(time, 0.25);
    H5Dclose(dataset);
    H5Fclose(file);
}

TEST(Checkpoint, NoticesEveryFlippedByte) {
    const ScratchFolder folder;
    const std::filesystem::path path = write_one(folder);
    const std::string whole = contents_of(path);
    for (std::size_t at = 0; at < whole.size(); at += 7) {   // every part of the file; 7 divides no length in it
        std::string flipped = whole;
        flipped[at] = char(flipped[at] ^ 1);
        EXPECT_THROW(expect_checkpoint(flipped, path), CheckpointError) << at;
    }
    std::string flipped = whole;
    flipped[whole.size() / 2] ^= 4;
    put(path, flipped);
    EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { CheckpointReader reader(path); }), "checksum"));
}

TEST(Checkpoint, NoticesEveryTruncation) {
    const ScratchFolder folder;
    const std::filesystem::path path = write_one(folder);
    const std::string whole = contents_of(path);
    for (std::size_t size = 0; size < whole.size(); size += 13)
        EXPECT_THROW(expect_checkpoint(std::string_view(whole).substr(0, size), path), CheckpointError) << size;
    for (std::size_t size : {whole.size() - 1, std::size_t{512}, std::size_t{100}}) {
        std::filesystem::resize_file(path, size);
        EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { CheckpointReader reader(path); }), "truncated")) << size;
    }
    put(path, "");
    EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { CheckpointReader reader(path); }), "not a checkpoint"));
    put(path, "solid lumen\n" + std::string(1000, ' '));
    EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { CheckpointReader reader(path); }), "not a checkpoint"));
}

TEST(Checkpoint, RefusesOtherVersions) {
    const ScratchFolder folder;
    const std::filesystem::path path = write_one(folder);
    std::string whole = contents_of(path);
    const std::string line = fmt::format("version {}\n", checkpoint_version);
    const std::size_t at = whole.find(line);
    ASSERT_NE(at, whole.npos);
    whole[at + line.size() - 2] = '9';
    put(path, whole);
    const std::string sentence = sentence_of<CheckpointError>([&] { CheckpointReader reader(path); });
    EXPECT_TRUE(has(sentence, "version \"9\""));
    EXPECT_TRUE(has(sentence, path.string()));
}

TEST(Checkpoint, NamesFieldsThatDoNotFit) {
    const ScratchFolder folder;
    const CheckpointReader reader(write_one(folder));
    const auto sentence_for = [&](ParticleSet& set) {
        set.resize(3);
        const std::string sentence = sentence_of<CheckpointError>([&] { reader.read(set, "fluid"); });
        EXPECT_EQ(set.size(), 3u);   // stays as it was
        return sentence;
    };
    struct : Blood {
        Field<double> age{*this, "age", "s", Keep::state};
    } more;
    EXPECT_TRUE(has(sentence_for(more), "no field 'age'"));
    struct : ParticleSet {
        Field<Vec3> position{*this, "position", "m", Keep::state};
        Field<Mat3> gradient{*this, "gradient", "1/s", Keep::state};
        Field<std::int32_t> origin{*this, "origin", "1", Keep::state};
        Field<double> density{*this, "density", "kg/m^3", Keep::scratch};
    } less;
    EXPECT_TRUE(has(sentence_for(less), "'density' that nothing"));
    struct : ParticleSet {
        Field<double> position{*this, "position", "m", Keep::state};
    } flat;
    EXPECT_TRUE(has(sentence_for(flat), "'position' of fluid has another shape"));
    struct : ParticleSet {
        Field<Vec3> position{*this, "position", "mm", Keep::state};
    } other_unit;
    EXPECT_TRUE(has(sentence_for(other_unit), "in 'm', not in 'mm'"));
    Blood blood;
    EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { reader.read(blood, "wall"); }), "no particles 'wall'"));
}

TEST(Checkpoint, NamesValuesThatDoNotFit) {
    const ScratchFolder folder;
    const CheckpointReader reader(write_one(folder));
    EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { reader.read<double>("clock"); }), "no value 'clock'"));
    EXPECT_TRUE(has(sentence_of<CheckpointError>([&] { reader.read<double>("clock/of/none"); }), "no value"));
    EXPECT_TRUE(
        has(sentence_of<CheckpointError>([&] { reader.read<std::int64_t>("time"); }), "'time' is not one of integers"));
    EXPECT_TRUE(
        has(sentence_of<CheckpointError>([&] { reader.read<std::vector<double>>("time"); }), "'time' is not a list"));
}

TEST(Checkpoint, SaysWhatChanged) {
    const ScratchFolder folder;
    const CheckpointReader reader(write_one(folder));
    EXPECT_EQ(reader.origin(), origin);
    EXPECT_NO_THROW(reader.expect_origin(origin));
    const auto sentence_for = [&](CheckpointOrigin present) {
        return sentence_of<CheckpointError>([&] { reader.expect_origin(present); });
    };
    EXPECT_TRUE(has(sentence_for({"d2", "b2", origin.input_hashes}), ": the deck and the program."));
    EXPECT_TRUE(has(sentence_for({"d1", "b1", {{"lumen of patient 3.stl", "s2"}, {"inflow.csv", "c1"}}}),
                    ": 'lumen of patient 3.stl'."));
    EXPECT_TRUE(has(sentence_for({"d1", "b1", {{"lumen of patient 3.stl", "s1"}, {"other.csv", "c1"}}}),
                    "'other.csv' (new) and 'inflow.csv' (no longer used)"));
}

TEST(Checkpoint, KeepsThePreviousOneUntilTheNewOneIsComplete) {
    const ScratchFolder folder;
    const std::filesystem::path path = write_one(folder);
    const std::string before = contents_of(path);
    Blood blood;
    fill(blood, 5);
    {
        CheckpointWriter abandoned(path, origin);
        abandoned.write(blood, "fluid");
    }
    EXPECT_EQ(contents_of(path), before);
    {
        CheckpointWriter writer(path, origin);
        writer.write(blood, "fluid");
        const FileSizeLimit limit(600);
        EXPECT_TRUE(has(sentence_of<FileError>([&] { writer.finish(); }), path.string()));
    }
    EXPECT_EQ(contents_of(path), before);
    blood.gradient[3].y.z = std::nan("");
    CheckpointWriter writer(path, origin);
    const std::string sentence = sentence_of<DivergedError>([&] { writer.write(blood, "fluid"); });
    EXPECT_TRUE(has(sentence, "gradient of fluid particle 3 is nan"));
    EXPECT_EQ(contents_of(path), before);
}

TEST(Checkpoint, CannotBeWrittenWhereThereIsNoFolder) {
    const ScratchFolder folder;
    CheckpointWriter writer(folder / "none/c.h5", origin);
    writer.write("time", 1.0);
    EXPECT_TRUE(has(sentence_of<FileError>([&] { writer.finish(); }), "none/c.h5"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { CheckpointReader reader(folder / "none/c.h5"); }), "none/c.h5"));
}

TEST(Checkpoint, WritesANameOnce) {
    const ScratchFolder folder;
    CheckpointWriter writer(folder / "c.h5", origin);
    writer.write("time", 1.0);
    EXPECT_THROW(writer.write("time", 2.0), CheckpointError);
}

}   // namespace
}   // namespace patency
