// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/run_solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/csv.h"
#include "patency/io/pvd.h"
#include "patency/io/summary.h"
#include "patency/stages/flow_checkpoint.h"
#include "patency/stages/solid_checkpoint.h"
#include "patency/stages/solid_output.h"
#include "patency/stages/stopwatch.h"

namespace patency {

namespace {

constexpr int rows_of_energies = 200;   // over the duration, where the deck names no interval

class SolidJob {
public:
    SolidJob(const deck::Case& config, const SolidStage& stage)
        : config_(config),
          stage_(stage),
          origin_(origin_of(config, stage.binary_hash)),
          checkpoint_(stage.folder.checkpoint("solid")) {
        scene_ = build_solids(config);
        is_resumed_ = stage.folder.has_checkpoint("solid");
        if (is_resumed_) {
            const CheckpointReader reader(checkpoint_);
            reader.expect_origin(origin_);
            read_solid_checkpoint(reader, *scene_);
            say(fmt::format("goes on at {:.6g} s", scene_->time));
        } else {
            deck::write_case(config, stage.folder.file("case.resolved.yaml"));
        }
        for (const auto& part : scene_->system.parts) {
            const ElasticModuli m = part->solid.materials[0].moduli();
            say(fmt::format("{}: {} particles; E {:.4g} Pa, nu {:.4g}, G {:.4g} Pa, K {:.4g} Pa", part->name,
                            part->body->particles().size(), m.young(), m.poisson(), m.shear, m.bulk));
            const auto file = stage.folder.file(part->name + ".pvd");
            series_.push_back(is_resumed_ ? PvdWriter::resumed(file, scene_->time) : PvdWriter(file));
        }
        say(fmt::format("stable step {:.4g} s", stable_step(scene_->system)));
        const std::vector<std::string> columns = {"time_s",         "kinetic_j",         "elastic_j",
                                                  "hourglass_j",    "plastic_j",         "contact_j",
                                                  "viscous_loss_j", "drag_loss_j",       "friction_loss_j",
                                                  "load_work_j",    "constraint_work_j", "damping_loss_j",
                                                  "tool_work_j",    "hourglass_loss_j"};
        const auto table = stage.folder.file("energies.csv");
        energies_ = std::make_unique<CsvWriter>(is_resumed_ ? CsvWriter::resumed(table, columns, scene_->time)
                                                            : CsvWriter(table, columns));
        last_checkpoint_ = scene_->time;
    }

    bool run() {
        try {
            return advance();
        } catch (const DivergedError& error) {
            write_polydata(stage_.folder.file("offenders.vtp"), remains(),
                           {.time = scene_->time, .non_finite = NonFinite::allow});
            throw DivergedError(fmt::format("{}; the solids as they were are in offenders.vtp", error.what()));
        }
    }

private:
    void say(const std::string& line) const { stage_.log(LogLevel::info, line); }

    bool advance() {
        const double end = config_.numerics.duration, interval = config_.output.interval.value_or(end),
                     row = std::min(interval, end / rows_of_energies);
        if (!is_resumed_) {
            write_row();
            if (config_.output.interval) write_frames();
        }
        while (scene_->time < end) {
            const double next_row = next_after(scene_->time, row), next_frame = next_after(scene_->time, interval);
            const double until = std::min({next_row, next_frame, end});
            step_solids(*scene_, until);
            if (scene_->time == until) {
                // Multiples of two intervals may be one time but for round-off.
                const auto is_reached = [&](double next) { return until >= next * (1 - rounding) || until == end; };
                if (is_reached(next_row)) write_row();
                if (is_reached(next_frame)) write_frames();
            }
            if (stage_.progress) stage_.progress->update(progress());
            const bool is_interrupted = scene_->time < end && stage_.interrupted && stage_.interrupted();
            if (is_interrupted || scene_->time == end || is_checkpoint_due()) write_checkpoint();
            if (is_interrupted) {
                say(fmt::format("interrupted at {:.6g} s; a checkpoint was written", scene_->time));
                return false;
            }
        }
        if (stage_.progress) stage_.progress->finish(progress());
        write_summary(stage_.folder.file("summary.json"), solid_summary(*scene_));
        write_timing(stage_.folder, {{"solids", {{"cpu_s", watch_.cpu()}, {"wall_s", watch_.wall()}}}});
        say(fmt::format("done: {} steps in {:.1f} s", scene_->steps, watch_.wall()));
        return true;
    }

    static constexpr double rounding = 1e-12;

    /// The first multiple of `interval` after a time that may be one itself, to round-off.
    static double next_after(double time, double interval) {
        return interval * (std::floor(time / interval * (1 + rounding)) + 1);
    }

    bool is_checkpoint_due() const {   // between steps, and clips none: when it is written changes no bit
        const auto& every = config_.output.checkpoint_interval;
        if (every) return std::floor(scene_->time / *every) > std::floor(last_checkpoint_ / *every);
        return watch_.wall() - last_checkpoint_wall_ > stage_.wall_between_checkpoints;
    }
    void write_checkpoint() {
        write_solid_checkpoint(checkpoint_, origin_, *scene_);
        last_checkpoint_ = scene_->time, last_checkpoint_wall_ = watch_.wall();
    }

    ProgressState progress() const {
        return {.stage = "solids",
                .fraction = scene_->time / config_.numerics.duration,
                .time = scene_->time,
                .step = scene_->steps};
    }

    void write_row() {
        SolidEnergy sum;
        ContactReport contact;
        for (auto& part : scene_->system.parts) {
            const SolidEnergy e = part->body->energy();
            sum.kinetic += e.kinetic, sum.elastic += e.elastic, sum.hourglass += e.hourglass, sum.plastic += e.plastic;
            sum.yielded += e.yielded, sum.viscous += e.viscous, sum.drag += e.drag, sum.load_work += e.load_work,
                sum.constraint_work += e.constraint_work;
        }
        for (const auto& c : scene_->system.contacts) {
            const ContactReport r = c->report();
            contact.energy += r.energy, contact.friction_loss += r.friction_loss,
                contact.damping_loss += r.damping_loss, contact.work += r.work;
        }
        energies_->write_row({scene_->time, sum.kinetic, sum.elastic, sum.hourglass, sum.plastic, contact.energy,
                              sum.viscous, sum.drag, contact.friction_loss, sum.load_work, sum.constraint_work,
                              contact.damping_loss, contact.work, sum.yielded});
    }

    void write_frames() {
        for (std::size_t k = 0; k < series_.size(); ++k) {
            SolidPart& part = *scene_->system.parts[k];
            const auto file = frame_file(part.name, series_[k].size());
            write_polydata(stage_.folder.root() / file, solid_picture(part), {.time = scene_->time});
            series_[k].add(scene_->time, file);
        }
    }

    PolyData remains() const {
        PolyData data;
        PointArray velocity{"velocity", "m/s", 3}, volume{"volume_ratio", "1", 1};
        for (const auto& part : scene_->system.parts) {
            const SolidParticles& p = part->body->particles();
            for (std::size_t i = 0; i < p.size(); ++i) {
                data.points.push_back(p.position[i]);
                velocity.values.insert(velocity.values.end(), {p.velocity[i].x, p.velocity[i].y, p.velocity[i].z});
                volume.values.push_back(determinant(part->body->deformation(i)));
            }
        }
        data.arrays = {velocity, volume};
        return data;
    }

    const deck::Case& config_;
    SolidStage stage_;
    Stopwatch watch_;
    std::unique_ptr<SolidScene> scene_;
    std::vector<PvdWriter> series_;
    std::unique_ptr<CsvWriter> energies_;
    CheckpointOrigin origin_;
    std::filesystem::path checkpoint_;
    bool is_resumed_ = false;
    double last_checkpoint_ = 0, last_checkpoint_wall_ = 0;
};

}   // namespace

bool run_solids(const deck::Case& config, const SolidStage& stage) { return SolidJob(config, stage).run(); }

}   // namespace patency
