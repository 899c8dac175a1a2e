// SPDX-License-Identifier: Apache-2.0
#include "patency/io/progress.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "patency/base/errors.h"
#include "patency/io/log_file.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

struct Listener {
    std::vector<std::string> texts;
    double now = 1000;

    Progress progress(ProgressOptions options) {
        options.clock = [this] { return now; };
        return Progress([this](std::string_view text) { texts.emplace_back(text); }, options);
    }
};

TEST(Progress, SaysWhatAPersonWants) {
    const ProgressState state{.stage = "flow", .fraction = 0.4299, .time = 0.42, .step = 12000, .net_inflow = 2e-9};
    // 2e-9 m^3/s * 60 s/min * 1e6 mL/m^3 = 0.12 mL/min
    EXPECT_EQ(progress_text(state, 80), "flow:  42 %  t 0.42 s  step 12000  in-out +0.12 mL/min  left 1 min 20 s");
    EXPECT_EQ(progress_text({.stage = "deploy", .fraction = 1, .time = 1e-3, .step = 7}, std::nullopt),
              "deploy: 100 %  t 0.001 s  step 7");
    EXPECT_EQ(duration_text(59.4), "59 s");
    EXPECT_EQ(duration_text(59.6), "1 min 00 s");
    EXPECT_EQ(duration_text(2 * 3600 + 5 * 60), "2 h 05 min");
    EXPECT_EQ(duration_text(-1), "0 s");
}

TEST(Progress, WritesALineNowAndThen) {
    Listener listener;
    Progress progress = listener.progress({.style = ProgressStyle::lines, .interval = 30});
    for (int second = 0; second <= 100; ++second, listener.now += 1)
        progress.update({.stage = "flow", .fraction = second / 100.0, .time = 0, .step = second});
    ASSERT_EQ(listener.texts.size(), 4u);   // at 0, 30, 60 and 90 s
    EXPECT_TRUE(has(listener.texts[1], "step 30"));
    EXPECT_TRUE(has(listener.texts[1], "left 1 min 10 s"));
    EXPECT_EQ(listener.texts[1].back(), '\n');
    progress.finish({.stage = "flow", .fraction = 1, .time = 0, .step = 100});
    ASSERT_EQ(listener.texts.size(), 5u);
    EXPECT_TRUE(has(listener.texts[4], "100 %"));
}

TEST(Progress, CountsTheTimeLeftFromWhereItResumed) {
    Listener listener;
    Progress progress = listener.progress({.interval = 10});
    progress.update({.stage = "flow", .fraction = 0.8});
    listener.now += 10;
    progress.update({.stage = "flow", .fraction = 0.9});   // 0.1 in 10 s
    ASSERT_EQ(listener.texts.size(), 2u);
    EXPECT_FALSE(has(listener.texts[0], "left"));
    EXPECT_TRUE(has(listener.texts[1], "left 10 s"));
    progress.update({.stage = "deploy", .fraction = 0});   // a new stage speaks at once
    EXPECT_TRUE(has(listener.texts.back(), "deploy"));
}

TEST(Progress, RenewsTheLineOfATerminal) {
    Listener listener;
    Progress progress = listener.progress({.style = ProgressStyle::terminal, .interval = 0.2, .width = 10});
    progress.update({.stage = "a long name of a stage", .fraction = 0});
    ASSERT_EQ(listener.texts.size(), 1u);
    EXPECT_EQ(listener.texts[0], "\ra long na\x1b[K");   // one column less than the terminal has: no wrap
    progress.finish({.stage = "a", .fraction = 1});
    EXPECT_EQ(listener.texts.back(), "\n");
}

TEST(Progress, IsSilentWithoutASink) {
    Progress progress;
    EXPECT_NO_THROW(progress.update({.stage = "flow", .fraction = 0.5}));
    EXPECT_NO_THROW(progress.finish({.stage = "flow", .fraction = 1}));
}

TEST(LogFile, HasEveryMessageAtOnceWithItsLevel) {
    const ScratchFolder folder;
    std::vector<std::string> heard;
    const Log log = make_tee_log(make_file_log(folder / "log.txt", LogMode::begin),
                                 [&](LogLevel, std::string_view message) { heard.emplace_back(message); });
    log(LogLevel::warning, "the inlet is {small}");
    EXPECT_TRUE(has(contents_of(folder / "log.txt"), "warning: the inlet is {small}\n"));
    EXPECT_EQ(heard, std::vector<std::string>{"the inlet is {small}"});
    make_file_log(folder / "log.txt", LogMode::append)(LogLevel::info, "resumed");
    EXPECT_TRUE(has(contents_of(folder / "log.txt"), "small"));
    EXPECT_TRUE(has(contents_of(folder / "log.txt"), "info: resumed\n"));
    make_file_log(folder / "log.txt", LogMode::begin);
    EXPECT_EQ(contents_of(folder / "log.txt"), "");
    put(folder / "file", "");
    EXPECT_TRUE(
        has(sentence_of<FileError>([&] { make_file_log(folder / "file/log.txt", LogMode::begin); }), "log.txt"));
}

}   // namespace
}   // namespace patency
