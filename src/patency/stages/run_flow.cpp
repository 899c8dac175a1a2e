// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/run_flow.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/stages/build.h"
#include "patency/stages/flow.h"
#include "patency/stages/flow_recorder.h"
#include "patency/stages/result_files.h"

namespace patency {

namespace {

/// Wall and processor time since it was made.
class Stopwatch {
public:
    double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(); }
    double cpu() const { return cpu_now() - cpu_; }

private:
    static double cpu_now() {
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
        return seconds(used.ru_utime) + seconds(used.ru_stime);
    }
    std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
    double cpu_ = cpu_now();
};

std::string machine_name() {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return name;
}

nlohmann::ordered_json make_timing(const Stopwatch& build, double build_wall, double build_cpu, const Scene& scene) {
    const double wall = build.wall() - build_wall, cpu = build.cpu() - build_cpu;
    return {{"build", {{"cpu_s", build_cpu}, {"wall_s", build_wall}}},
            {"flow",
             {{"cpu_s", cpu},
              {"wall_s", wall},
              {"particle_steps_per_cpu_s", cpu > 0 ? double(scene.fluid.size()) * double(scene.acoustic_steps) / cpu : 0.0}}},
            {"threads", omp_get_max_threads()},
            {"machine", machine_name()},
            {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))}};
}

void describe(const Scene& scene, const FlowStage& stage) {
    if (!stage.say) return;
    stage.say(fmt::format("{} particles of blood, {} of wall; density spread {:.2g} %", scene.fluid.size(), scene.wall.size(),
                          100 * scene.relax_quality.density_spread));
    stage.say(fmt::format("largest expected speed {:.4g} m/s, sound speed {:.4g} m/s", scene.numerics.reference_speed, scene.material.sound_speed));
}

}  // namespace

Outcome run_flow(const deck::Case& config, const FlowStage& stage) {
    const Stopwatch watch;
    open_result_folder(stage.out);
    // Results of an earlier run would be taken for this one's if it ended early.
    std::filesystem::remove(stage.out / "summary.json");
    deck::write_case(config, stage.out / "case.resolved.yaml");
    const auto scene = build_scene(config);
    FlowRecorder recorder(*scene);
    const double build_wall = watch.wall(), build_cpu = watch.cpu();
    describe(*scene, stage);

    std::vector<TableFile> files;
    for (const RecordedTable& table : recorder.tables()) files.emplace_back(stage.out / (table.name + ".csv"), table.columns);
    recorder.write_row = [&](std::size_t table, std::span<const double> values) { files.at(table).write_row(values); };

    FlowRun run{.until = config.numerics.duration, .interrupted = stage.interrupted, .exact_times = recorder.exact_times()};
    run.observe = [&](const Scene& now, const FlowStep&) {
        recorder.observe(now);
        if (!stage.show) return;
        double out = 0;
        for (const OpenEnd& end : now.ends) out += end.flow;
        stage.show({now.time, run.until, now.acoustic_steps, -out, watch.wall()});
    };
    advance(*scene, run);
    if (scene->time < run.until) {
        if (stage.say) stage.say(fmt::format("interrupted at {:.6g} s", scene->time));
        return Outcome::interrupted;
    }
    write_text_file(stage.out / "summary.json", make_summary(*scene, recorder.window(*scene)).dump(2) + "\n");
    write_text_file(stage.out / "timing.json", make_timing(watch, build_wall, build_cpu, *scene).dump(2) + "\n");
    if (stage.say) stage.say(fmt::format("done: {} acoustic steps in {:.1f} s", scene->acoustic_steps, watch.wall() - build_wall));
    return Outcome::done;
}

}  // namespace patency
