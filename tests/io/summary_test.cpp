// SPDX-License-Identifier: Apache-2.0
#include "patency/io/summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

TEST(Summary, KeepsTheOrderOfKeysAndTheBitsOfNumbers) {
    const ScratchFolder folder;
    Json document;
    document["zeta"] = 0.1;
    document["alpha"]["flow_m3_per_s"] = 1.0 / 3;
    document["alpha"]["ffr"] = nullptr;
    document["count"] = 12;
    write_summary(folder / "summary.json", document);
    EXPECT_EQ(
        contents_of(folder / "summary.json"),
        "{\n  \"zeta\": 0.1,\n  \"alpha\": {\n    \"flow_m3_per_s\": 0.3333333333333333,\n    \"ffr\": null\n  },\n"
        "  \"count\": 12\n}\n");
    const Json read = read_summary(folder / "summary.json");
    EXPECT_EQ(read, document);
    EXPECT_EQ(read["alpha"]["flow_m3_per_s"].get<double>(), 1.0 / 3);
}

TEST(Summary, RefusesWhatIsNotFiniteAndNamesIt) {
    const ScratchFolder folder;
    for (double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        Json document;
        document["openings"]["inlet"]["flow_m3_per_s"] = bad;
        const std::string sentence = sentence_of<DivergedError>([&] { write_summary(folder / "s.json", document); });
        EXPECT_TRUE(has(sentence, "of openings.inlet.flow_m3_per_s would"));
        document = {{"lesions", {1.0, bad}}};
        EXPECT_TRUE(has(sentence_of<DivergedError>([&] { write_summary(folder / "s.json", document); }),
                        "of lesions[1] would"));
    }
    EXPECT_TRUE(folder.is_empty());
}

TEST(Summary, WritesTextThatIsNotUtf8) {
    const ScratchFolder folder;
    write_summary(folder / "s.json", Json{{"surface", "lumen\xff.stl"}});
    EXPECT_EQ(read_summary(folder / "s.json")["surface"], "lumen\xEF\xBF\xBD.stl");
}

TEST(Summary, SaysWhatItCannotReadOrWrite) {
    const ScratchFolder folder;
    put(folder / "s.json", "{\"a\": ");
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_summary(folder / "s.json"); }), "not a JSON document"));
    EXPECT_THROW(write_summary(folder / "none/s.json", Json::object()), FileError);
}

}   // namespace
}   // namespace patency
