// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/run_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/config/deck.h"
#include "patency/io/csv.h"
#include "patency/io/pvd.h"
#include "patency/io/summary.h"
#include "patency/io/vtp.h"
#include "patency/stages/build.h"
#include "patency/stages/cell_build.h"
#include "patency/stages/cell_flow.h"
#include "patency/stages/flow.h"
#include "patency/stages/flow_checkpoint.h"
#include "patency/stages/flow_recorder.h"
#include "patency/stages/flow_window.h"
#include "patency/stages/offenders.h"
#include "patency/stages/stopwatch.h"
#include "patency/stages/vessel_results.h"

namespace patency {

namespace {

// Instants that the means along a vessel are made of: a steady flow only trembles, a pulse has its form.
constexpr int steady_instants = 8, periodic_instants = 40;

bool is_steady_on_cells(const deck::Case& config) {
    return config.scheme() == deck::SchemeName::cells && config.about.mode == deck::Mode::steady;
}

/// One flow stage from its folder's state to its end.
class FlowJob {
public:
    /// watch: since the stage began. restless: a steady flow on cells that has no rest and is followed in time.
    FlowJob(const deck::Case& config, const FlowStage& stage, const Stopwatch& watch,
            const CellScene* restless = nullptr)
        : config_(config),
          stage_(stage),
          origin_(origin_of(config, stage.binary_hash)),
          checkpoint_(stage.folder.checkpoint("flow")),
          watch_(watch) {
        prepare(restless);
        expect_fields();
        if (config_.about.period && config_.numerics.duration < *config_.about.period * (1 - 1e-9))
            stage_.log(LogLevel::warning,
                       "numerics.duration ends before the first period does: means are of a part of it");
        if (is_steady_on_cells(config_))
            say(fmt::format("windows of {:.3g} ms, at most {:.3g} ms", 1e3 * window_->length(),
                            1e3 * config_.numerics.duration));
        else if (is_on_cells())
            say(fmt::format("{} cells, {} steps in a period", scene_->fluid.size(), config_.numerics.steps_per_period));
        else
            say(fmt::format("{} particles of blood, {} of wall, sound speed {:.4g} m/s", scene_->fluid.size(),
                            scene_->wall.size(), scene_->material.sound_speed));
        build_wall_ = watch_.wall(), build_cpu_ = watch_.cpu();
        steps_before_ = scene_->acoustic_steps;
    }

    Outcome run() {
        try {
            return advance_to_end();
        } catch (const DivergedError& error) {
            throw DivergedError(fmt::format("{}{}", error.what(), describe_remains()));
        }
    }

private:
    void say(const std::string& line) const { stage_.log(LogLevel::info, line); }

    bool is_on_cells() const { return config_.scheme() == deck::SchemeName::cells; }

    void prepare(const CellScene* restless) {
        std::optional<CheckpointReader> reader;
        if (stage_.folder.has_checkpoint("flow")) {
            reader.emplace(checkpoint_);
            reader->expect_origin(origin_);
            scene_ = read_scene(*reader, config_);
            say(fmt::format("goes on at {:.6g} s", scene_->time));
        } else {
            deck::write_case(config_, stage_.folder.file("case.resolved.yaml"));
            scene_ = restless ? build_cell_scene(config_, *restless) : build_scene(config_);
            if (!scene_->start_remark.empty()) say(scene_->start_remark);
        }
        config_.numerics = scene_->config.numerics;   // whose times a flow without rest has chosen
        recorder_.emplace(*scene_);
        window_.emplace(*scene_);
        if (scene_->vessel) vessel_.emplace(*scene_);
        if (reader) {
            read_recorder(*reader, *recorder_);
            read_window(*reader, *window_);
            if (vessel_) read_vessel_recorder(*reader, *vessel_);
        }

        const double now = scene_->time;
        for (const RecordedTable& table : recorder_->tables()) {
            const auto path = stage_.folder.file(table.name + ".csv");
            tables_.push_back(reader
                                  ? CsvWriter::resumed(path, table.columns, recorder_->last_row_of(tables_.size(), now))
                                  : CsvWriter(path, table.columns));
        }
        recorder_->write_row = [this](std::size_t table, std::span<const double> values) {
            tables_.at(table).write_row(values);
        };
        const auto series = stage_.folder.file("fluid.pvd");
        frames_.emplace(reader ? PvdWriter::resumed(series, now) : PvdWriter(series));
        is_resumed_ = reader.has_value();
    }

    void expect_fields() const {
        for (const std::string& name : config_.output.fields)
            if (!scene_->fluid.find(name)) {
                std::vector<std::string> known;
                for (const FieldBase* field : scene_->fluid.fields()) known.push_back(field->name());
                throw DeckError(fmt::format("output.fields: the blood has no field '{}'; it has {}", name,
                                            join(known, ", ", " and ")));
            }
    }

    Outcome advance_to_end() {
        if (!is_resumed_) {
            recorder_->begin(*scene_);
            if (config_.output.interval) write_frame();
        }
        FlowRun run{.until = config_.numerics.duration, .exact_times = exact_times()};
        run.interrupted = [this] { return is_at_end() || (stage_.interrupted && stage_.interrupted()); };
        run.observe = [this](const Scene&, const FlowStep&) { observe(); };
        if (!is_at_end()) advance(*scene_, run);   // or the last checkpoint is that of its end
        write_checkpoint();
        if (!is_at_end()) {
            say(fmt::format("interrupted at {:.6g} s; a checkpoint was written", scene_->time));
            return Outcome::interrupted;
        }
        if (stage_.progress) stage_.progress->finish(progress());
        write_results();
        write_timing(stage_.folder, make_timing());
        say(fmt::format("done: {} {} in {:.1f} s", scene_->acoustic_steps - steps_before_,
                        is_on_cells() ? "iterations" : "acoustic steps", watch_.wall() - build_wall_));
        if (!window_->is_watched() || window_->is_settled()) return Outcome::done;
        stage_.log(
            LogLevel::warning,
            "the flow had not settled at the end of numerics.duration: the results are marked; give it a longer one");
        return Outcome::unsettled;
    }

    bool is_at_end() const { return scene_->time >= window_->end(); }

    void write_results() {
        const FlowMark from = window_->begin().value(), to = mark_flow(*scene_);
        if (vessel_) vessel_->join_blocks();
        nlohmann::ordered_json summary = make_summary(*scene_, from);
        summary["made_from"] = origin_summary(origin_);
        if (window_->is_watched())
            summary["convergence"] = {{"is_converged", window_->is_settled()},
                                      {"change_percent", window_->change_percent()},
                                      {"tolerance_percent", config_.numerics.convergence->tolerance_percent},
                                      {"window_s", window_->length()},
                                      {"is_mean_over_time", is_steady_on_cells(config_)}};
        if (vessel_) {
            std::vector<double> pressures,
                out;   // out of cells, which store nothing; of particles sections are measured
            for (std::size_t k = 0; k < scene_->ends.size(); ++k) {
                const OpeningMean mean = mean_between(from, to, k, scene_->ends[k].area);
                pressures.push_back(mean.pressure);
                if (is_on_cells()) out.push_back(mean.flow);
            }
            const std::string& inlet = scene_->vessel->openings.front().opening.name;
            double at_inlet = 0, lowest = INFINITY;
            for (std::size_t k = 0; k < pressures.size(); ++k)
                (scene_->ends[k].name == inlet ? at_inlet : lowest) =
                    scene_->ends[k].name == inlet ? pressures[k] : std::min(lowest, pressures[k]);
            const VesselFlow flow = evaluate_vessel(*scene_, *vessel_, at_inlet, lowest, out);
            add_vessel_summary(summary, *scene_, *vessel_, flow);
            write_vessel_files(stage_.folder, *scene_, *vessel_, flow);
        }
        write_summary(stage_.folder.file("summary.json"), summary);
    }

    /// An instant of the means along the vessel is due: evenly over the window, the last at its end.
    bool is_instant_due() const {
        if (!vessel_) return false;
        if (window_->slides()) {   // evenly over every block, for any may be the last; its last instant is its end
            const double instant = 2 * window_->length() / steady_instants;
            return scene_->time - window_->block_begin() >= (double(vessel_->instants()) + 1) * instant * (1 - 1e-9);
        }
        if (!window_->begin()) return false;
        const double begin = window_->begin()->time, length = window_->end() - begin;
        const bool has_form = config_.about.mode == deck::Mode::periodic ||
                              is_steady_on_cells(config_);   // a pulse, or a jet that swings
        const int wanted = has_form ? periodic_instants : steady_instants;
        return double(vessel_->instants()) < std::floor((scene_->time - begin) / length * wanted + 1e-9);
    }

    std::vector<double> exact_times() const {
        std::vector<double> times = recorder_->exact_times();
        times.insert(times.end(), window_->exact_times().begin(), window_->exact_times().end());
        if (config_.output.interval)
            for (double n = 1; n * *config_.output.interval < config_.numerics.duration; ++n)
                times.push_back(n * *config_.output.interval);
        std::sort(times.begin(), times.end());
        return times;
    }

    void observe() {
        const bool is_block_end = window_->observe(*scene_), is_end = is_at_end();
        recorder_->observe(*scene_, is_end);
        if (vessel_ && window_->slides() && (is_block_end || is_end))
            vessel_->sample(*scene_);
        else if (is_instant_due())
            vessel_->sample(*scene_);
        if (vessel_ && is_block_end) vessel_->end_block(FlowWindow::blocks - 1);
        const auto& interval = config_.output.interval;
        if (is_end || (interval && scene_->time >= double(frames_->size()) * *interval)) write_frame();
        // Checkpoints lie between steps and clip none: when they are written changes no bit.
        const auto& every = config_.output.checkpoint_interval;
        const double age = watch_.wall() - last_checkpoint_wall_;
        const bool is_due = every ? std::floor(scene_->time / *every) > std::floor(last_checkpoint_ / *every)
                                  : age > stage_.wall_between_checkpoints;
        if (is_due && !is_end) write_checkpoint();
        if (stage_.progress) stage_.progress->update(progress());
    }

    void write_frame() {
        const auto file = frame_file("fluid", frames_->size());
        write_particles(stage_.folder.file(file.string()), scene_->fluid,
                        {.time = scene_->time, .fields = config_.output.fields, .pressure_level = scene_->level()});
        frames_->add(scene_->time, file);
    }

    void write_checkpoint() {
        write_flow_checkpoint(checkpoint_, origin_, *scene_, *recorder_, *window_, vessel_ ? &*vessel_ : nullptr);
        last_checkpoint_ = scene_->time;
        last_checkpoint_wall_ = watch_.wall();
    }

    ProgressState progress() const {
        double out = 0;
        for (const OpenEnd& end : scene_->ends) out += end.flow;
        return {.stage = "flow",
                .fraction = scene_->time / window_->end(),
                .time = scene_->time,
                .step = scene_->acoustic_steps,
                .net_inflow = -out};
    }

    nlohmann::ordered_json make_timing() const {
        const double wall = watch_.wall() - build_wall_, cpu = watch_.cpu() - build_cpu_;
        const double steps = double(scene_->acoustic_steps - steps_before_);
        return {{"build", {{"cpu_s", build_cpu_}, {"wall_s", build_wall_}}},
                {"flow",
                 {{"cpu_s", cpu},
                  {"wall_s", wall},
                  {"particle_steps_per_cpu_s", cpu > 0 ? double(scene_->fluid.size()) * steps / cpu : 0.0}}},
                {"resumed", is_resumed_}};
    }

    /// Writes the fastest particles, those without numbers first, and says what can be looked at.
    std::string describe_remains() const {
        const FluidParticles& fluid = scene_->fluid;
        std::vector<double> badness(fluid.size());
        for (std::size_t i = 0; i < fluid.size(); ++i)
            badness[i] = norm(fluid.velocity[i]) + 0 * (fluid.pressure[i] + norm(fluid.position[i]));
        const std::vector<std::uint32_t> worst = worst_of(badness);
        const auto path = stage_.folder.file("offenders.vtp");
        write_particles(
            path, fluid,
            {.time = scene_->time, .only = worst, .pressure_level = scene_->level(), .non_finite = NonFinite::allow});
        return fmt::format("; at {:.6g} s. The fastest particles are in {}{}", scene_->time, path.string(),
                           stage_.folder.has_checkpoint("flow") ? ", the last good checkpoint is kept" : "");
    }

    deck::Case config_;
    const FlowStage& stage_;
    CheckpointOrigin origin_;
    std::filesystem::path checkpoint_;
    const Stopwatch watch_;
    std::unique_ptr<Scene> scene_;
    std::optional<FlowRecorder> recorder_;
    std::optional<FlowWindow> window_;
    std::optional<VesselRecorder> vessel_;   // of a scene with a vessel
    std::vector<CsvWriter> tables_;
    std::optional<PvdWriter> frames_;
    bool is_resumed_ = false;
    double build_wall_ = 0, build_cpu_ = 0;
    std::int64_t steps_before_ = 0;
    double last_checkpoint_ = 0, last_checkpoint_wall_ = 0;
};

}   // namespace

Outcome run_flow(const deck::Case& config, const FlowStage& stage) {
    const Stopwatch watch;
    if (!is_steady_on_cells(config) || stage.folder.has_checkpoint("flow")) return FlowJob(config, stage, watch).run();
    return run_cell_flow(config, stage,
                         [&](const CellScene& restless) { return FlowJob(config, stage, watch, &restless).run(); });
}

}   // namespace patency
