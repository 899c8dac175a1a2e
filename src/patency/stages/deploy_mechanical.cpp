// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_mechanical.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/summary.h"
#include "patency/shape/exact_distance.h"
#include "patency/stages/deploy_contacts.h"
#include "patency/stages/deploy_pace.h"
#include "patency/stages/deploy_program.h"
#include "patency/stages/deploy_record.h"
#include "patency/stages/deploy_rest.h"
#include "patency/stages/deploy_results.h"
#include "patency/stages/deploy_state.h"
#include "patency/stages/flow_checkpoint.h"
#include "patency/stages/lumen_after.h"
#include "patency/stages/solid_checkpoint.h"
#include "patency/stages/stopwatch.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

// What a stent takes up when it is let go is a small part of its internal energy, which is that of having been opened.
constexpr double quieter_when_let_go = 4;
constexpr int looks = 400;   // rows of deployment.csv, if the program ends as usual

class Deployment {
public:
    Deployment(const deck::Case& config, const DeployStage& stage)
        : config_(config),
          stage_(stage),
          origin_(origin_of(config, stage.binary_hash)),
          checkpoint_(stage.folder.checkpoint("deploy")) {
        const bool goes_on = stage.folder.has_checkpoint("deploy");
        scene_ = build_deployment(config);
        program_ = make_deploy_program(scene_->place, config.deployment);
        pace_ = DeployPace(row(), config.deployment.slowing);
        contacts_ = std::make_unique<DeployContacts>(*scene_, program_, pace_);
        stent_ = &contacts_->stent(), wall_ = &contacts_->wall();
        if (goes_on)
            read_checkpoint();
        else
            deck::write_case(config, stage.folder.file("case.resolved.yaml"));
        tell_plan();
        record_ = std::make_unique<DeployRecord>(stage_.folder, goes_on ? std::optional(time()) : std::nullopt);
    }

    bool run() {
        const auto& phases = program_.phases;
        for (std::size_t k = contact_steps_.empty() ? 0 : contact_steps_.size() - 1; k < phases.size(); ++k) {
            if (k == contact_steps_.size()) begin(phases[k].phase, {});
            if (!advance(phases[k])) return false;
            end(phases[k].phase);
        }
        write_checkpoint();   // whatever becomes of what is made of it
        finish();
        return true;
    }

private:
    void say(const std::string& line) const { stage_.log(LogLevel::info, line); }
    SolidSystem& system() { return scene_->solids.system; }
    double time() const { return scene_->solids.time; }
    double row() const { return program_.usual_end / looks; }   // of the program [s]
    double passed() const { return done_ - skipped_; }          // of the program [s]
    double left() const {                                       // of the program, as far as is known [s]
        const double at_least = phase_ == DeployPhase::settle ? row() : program_.usual_end - program_.deflate_from;
        return std::max(program_.usual_end - passed(), at_least);
    }

    void tell_plan() {
        const StentPlace& place = scene_->place;
        say(fmt::format(
            "stent: {:.4g} x {:.4g} mm along {:.4g} to {:.4g} mm from the inlet; crimped to {:.4g}, opened to {:.4g} "
            "mm; the lumen there is {:.3g} mm at its narrowest, "
            "{:.3g} mm where healthy",
            1e3 * place.pattern.diameter, 1e3 * place.pattern.length, 1e3 * place.start_arc(), 1e3 * place.end_arc(),
            1e3 * place.crimped_diameter, 1e3 * place.diameter, 1e3 * place.narrowest, 1e3 * place.reference_diameter));
        say(
            fmt::format("stent: {} particles {:.3g} um apart, {} vertices, mass times {:.4g}; wall: {} particles "
                        "{:.3g} mm apart, {} vertices; {} ends",
                        stent_->body->particles().size(), 1e6 * scene_->stent_spacing, stent_->surface->size(),
                        scene_->mass_scaling, wall_->body->particles().size(), 1e3 * scene_->wall_spacing,
                        wall_->surface->size(), scene_->field->ends().size()));
        say(fmt::format("stable steps: stent {:.3g} s, wall {:.3g} s; about {:.3g} s in all",
                        stent_->body->stable_step(), wall_->body->stable_step(), program_.usual_end));
    }

    void begin(DeployPhase phase, std::optional<double> known_step) {
        contact_steps_.push_back(contacts_->begin(phase, known_step));
        phase_ = phase;
        if (known_step) return;   // the pace is known too
        rest_.begin();
        if (phase == DeployPhase::open) pace_.set_out(time());
        if (phase == DeployPhase::settle) pace_.rest(time());
    }

    bool advance(const DeployProgram::Entry& entry) {
        if (time() == 0) {
            look();
            marks_.crimped_length = profile_.length, marks_.crimped_diameter = profile_.mean_diameter;   // as it came
        }
        while (done_ < entry.end) {
            const double next = std::min(entry.end, row() * (std::floor(done_ / row() * (1 + 1e-9)) + 1)),
                         next_time = pace_.time_of(next);
            bool is_stopped = false;
            while (time() < next_time && !is_stopped) {
                step_solids(scene_->solids, next_time);
                is_stopped = stage_.interrupted && stage_.interrupted();
            }
            if (time() >= next_time) {
                done_ = next;
                look();
                RadialLoad* load = contacts_->load();
                if (load && !load->is_filled() && phase_ <= DeployPhase::hold &&
                    profile_.mean_diameter >= scene_->place.diameter)
                    stop_filling(*load);
                if (is_over()) skip_to(entry.end);
            }
            if (stage_.progress)
                stage_.progress->update({.stage = std::string(name_of(entry.phase)),
                                         .fraction = passed() / (passed() + left()),
                                         .time = time(),
                                         .step = scene_->solids.steps});
            if (is_stopped || is_checkpoint_due()) write_checkpoint();
            if (is_stopped) {
                say(fmt::format("interrupted at {:.6g} s; a checkpoint was written", time()));
                return false;
            }
        }
        return true;
    }

    /// Between steps: when it is written changes no bit.
    void write_checkpoint() {
        CheckpointWriter writer(checkpoint_, origin_);
        write_solids(writer, system(), "solids");
        writer.write("time", scene_->solids.time);
        writer.write("dt", scene_->solids.dt);
        writer.write("steps", scene_->solids.steps);
        writer.write("contact_steps", contact_steps_);
        std::vector<double> known;
        for (const double* x : known_numbers()) known.push_back(*x);
        writer.write("known", known);
        writer.finish();
        last_checkpoint_wall_ = watch_.wall(), last_checkpoint_ = time();
    }
    /// Where the deck's interval is over; and now and then all the same, for it may be meant for a flow's seconds.
    bool is_checkpoint_due() const {
        const auto& interval = config_.output.checkpoint_interval;
        return watch_.wall() - last_checkpoint_wall_ > stage_.wall_between_checkpoints ||
               (interval && time() - last_checkpoint_ >= *interval);
    }
    void read_checkpoint() {
        const CheckpointReader reader(checkpoint_);
        reader.expect_origin(origin_);
        const auto steps = reader.read<std::vector<double>>("contact_steps");
        for (std::size_t k = 0; k < steps.size(); ++k) begin(program_.phases.at(k).phase, steps[k]);
        read_solids(reader, system(), "solids");
        scene_->solids.time = reader.read<double>("time");
        scene_->solids.dt = reader.read<double>("dt");
        scene_->solids.steps = steps_before_ = reader.read<std::int64_t>("steps");
        const auto known = reader.read<std::vector<double>>("known");
        const auto to = known_numbers();
        for (std::size_t k = 0; k < to.size(); ++k) *to[k] = known.at(k);
        measure();
        last_checkpoint_ = time(), is_resumed_ = true;
        say(fmt::format("goes on at {:.6g} s", time()));
    }
    /// What is known of the past.
    std::vector<double*> known_numbers() {
        std::vector<double*> all = marks_.numbers();
        for (const auto& more :
             {contacts_->numbers(), pace_.numbers(), rest_.numbers(), std::vector{&done_, &skipped_}})
            all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    /// The stent is let go where the balloon has left it and it does not go after; and it is done when it is at rest.
    bool is_over() {
        const double ramp = config_.deployment.ramp;
        if (phase_ == DeployPhase::settle) return rest_.compare(done_, profile_, 0.1 * ramp) && is_at_rest();
        if (phase_ != DeployPhase::deflate) return false;
        if (contacts_->have_pressed(done_)) rest_.begin();
        return rest_.compare(done_, profile_, 0.05 * ramp) && rest_.shrunk() < 2e-3;
    }
    bool is_at_rest() const { return 100 * rest_.moved() < most_drift_percent; }
    void skip_to(double program) {
        skipped_ += program - done_;
        pace_.skip_to(time(), program);
        done_ = program;
    }

    void stop_filling(RadialLoad& load) const {
        say(fmt::format("a load of {:.4g} MPa opened the stent to {:.4g} mm", 1e-6 * load.pressure(done_),
                        1e3 * profile_.mean_diameter));
        load.fill(done_);
    }

    /// The stent where it is at the end of a step.
    void measure() {
        stent_->surface->follow(stent_->body->particles());
        profile_ = measure_stent_profile(seen_from(scene_->place.axis, outer_faces_of(*stent_).places),
                                         slices_for(scene_->place.pattern));
    }

    /// A row of the table, now and then a picture.
    void look() {
        measure();
        const BodyEnergy stent = energy_of(*stent_), wall = contacts_->has_wall() ? energy_of(*wall_) : BodyEnergy{};
        const double pressure = contacts_->tool_pressure(done_);
        if (const Contact* touch = contacts_->stent_on_wall())
            marks_.deepest = std::max(marks_.deepest, touch->report().deepest);
        if (phase_ == DeployPhase::open) marks_.balloon_pressure = std::max(marks_.balloon_pressure, pressure);
        record_->add(
            {time(), phase_, contacts_->tool_radius(done_), pressure, stent, wall, marks_.deepest, pace_.rate(time())},
            profile_);
        keep_pace(stent.ratio(), wall.ratio());
        const double frame = program_.usual_end / config_.deployment.frames;
        if (record_->frames() == 0 || passed() >= frame * double(record_->frames()) - 0.5 * row())
            write_frames(nullptr);
    }

    /// What counts of kinetic over internal energies, and what is made of it.
    void keep_pace(double stent, double wall) {
        if (phase_ == DeployPhase::deflate) pace_.heed(time(), quieter_when_let_go * stent);
        if (phase_ != DeployPhase::open) return;
        const double first_tenth =
            0.1 * config_.deployment.ramp;   // of the stent's way; the wall's begins where it is touched
        if (marks_.touched == 0 && marks_.deepest > 0) marks_.touched = done_;
        if (done_ > program_.open_from + first_tenth) marks_.stent_ratio = std::max(marks_.stent_ratio, stent);
        const bool wall_counts = marks_.touched > 0 && done_ > marks_.touched + first_tenth;
        if (wall_counts) marks_.wall_ratio = std::max(marks_.wall_ratio, wall);
        pace_.heed(time(), wall_counts ? std::max(stent, wall) : stent);
    }

    void write_frames(const SignedDistance* lumen) {
        record_->add_frames(time(), stent_picture(*stent_, lumen), wall_picture(*wall_));
    }

    /// A crimper that left a part of the stent behind has lost it.
    void expect_crimped() const {
        const double wanted = scene_->place.crimped_diameter, allowed = wanted + scene_->place.pattern.strut_thickness;
        if (profile_.most_diameter > allowed)
            throw DivergedError(
                fmt::format("the crimper lost a part of the stent, which is up to {:.4g} mm wide where {:.4g} mm were "
                            "wanted (stent.pvd shows where): "
                            "crimp it less, or give deployment.steps more",
                            1e3 * profile_.most_diameter, 1e3 * wanted));
    }

    void end(DeployPhase phase) {
        say(fmt::format(
            "{} done at {:.4g} ms: diameter {:.4g} mm ({:.4g} to {:.4g}), length {:.4g} mm; {} steps, {:.0f} s",
            name_of(phase), 1e3 * time(), 1e3 * profile_.mean_diameter, 1e3 * profile_.least_diameter,
            1e3 * profile_.most_diameter, 1e3 * profile_.length, scene_->solids.steps, watch_.wall()));
        if (phase == DeployPhase::crimp) expect_crimped();
        if (phase == DeployPhase::open && pace_.least_rate() < 1)
            say(fmt::format(
                "at its own pace the ramp took {:.2f} times as long, and at the slowest {:.2f} of its speed",
                1 + (time() - done_) / config_.deployment.ramp, pace_.least_rate()));
        if (phase <= DeployPhase::enter)
            marks_.crimped_length = profile_.length, marks_.crimped_diameter = profile_.mean_diameter;
        if (phase == DeployPhase::hold)
            marks_.opened_diameter = profile_.mean_diameter, marks_.opened_length = profile_.length;
    }

    void finish() {
        Vessel after =
            write_lumen_after(config_, scene_->vessel, scene_->lumen_now(wall_->body->particles()), stage_.folder);
        follow_vessel(after);
        const SignedDistance lumen = make_exact_distance(closed_at(after.checked.surface, after.checked.ends));
        write_frames(&lumen);
        const OuterFaces outer = outer_faces_of(*stent_);
        const StentAxis& axis = scene_->place.axis;
        const StrutFit fit = measure_fit(outer.places, outer.areas, axis, lumen);
        write_stent_table(stage_.folder.file("stent.csv"), profile_);
        const LumenGain gain = lumen_gain(scene_->place, *scene_->vessel.along, after);

        Json deploy = {{"mode", std::string(deck::word_of(config_.deployment.mode))}, {"is_mechanical", true}};
        deploy.update(deploy_summary(scene_->place, profile_, fit, find_jailed_ostia(profile_, axis, lumen), gain));
        deploy["crimped_diameter_mm"] = 1e3 * marks_.crimped_diameter;
        deploy["crimped_length_mm"] = 1e3 * marks_.crimped_length;
        deploy["opened_diameter_mm"] = 1e3 * marks_.opened_diameter;
        deploy["opened_over_wanted"] = marks_.opened_diameter / scene_->place.diameter;
        deploy["recoil_percent"] = 100 * recoil(marks_.opened_diameter, profile_.mean_diameter);
        deploy["foreshortening_percent"] = 100 * foreshortening(marks_.crimped_length, profile_.length);
        deploy["penetration_over_spacing"] = marks_.deepest / scene_->stent_spacing;
        deploy["kinetic_to_internal"] = std::max(marks_.stent_ratio, marks_.wall_ratio);
        deploy["kinetic_to_internal_stent"] = marks_.stent_ratio;
        deploy["kinetic_to_internal_wall"] = marks_.wall_ratio;
        deploy["drift_percent"] = 100 * rest_.moved();
        deploy["slowest_pace"] = pace_.least_rate();
        deploy["drag_loss_to_internal_stent"] = stent_->body->energy().drag / energy_of(*stent_).internal;
        deploy["energies"] = energies_json(system(), contacts_->account(), !contacts_->load());
        deploy["largest_tool_pressure_pa"] = marks_.balloon_pressure;
        deploy["stresses"] = stresses_json(*stent_, *wall_, axis, profile_.length, contacts_->stent_on_wall()->pushes(),
                                           scene_->wall_spacing);
        deploy["particles"] = {{"stent", stent_->body->particles().size()}, {"wall", wall_->body->particles().size()}};
        deploy["spacing_mm"] = {{"stent", 1e3 * scene_->stent_spacing}, {"wall", 1e3 * scene_->wall_spacing}};
        deploy["mass_scaling"] = scene_->mass_scaling;
        deploy["steps"] = scene_->solids.steps;
        write_summary(stage_.folder.file("summary.json"), {{"deploy", deploy}});
        const std::int64_t steps = scene_->solids.steps - steps_before_;
        const double particle_steps = double(steps) * double(stent_->body->particles().size());
        write_timing(stage_.folder, {{"deploy",
                                      {{"cpu_s", watch_.cpu()},
                                       {"wall_s", watch_.wall()},
                                       {"steps", steps},
                                       {"stent_particle_steps_per_s", particle_steps / watch_.wall()},
                                       {"resumed", is_resumed_}}}});
        if (stage_.progress)
            stage_.progress->finish({.stage = "deploy", .fraction = 1, .time = time(), .step = scene_->solids.steps});
        say(
            fmt::format("done: stent {:.4g} mm, recoil {:.2f} %, lumen {:.3g} mm at its narrowest (before {:.3g}), "
                        "residual stenosis {:.1f} %; {} steps, {} of them now in {:.0f} s",
                        1e3 * profile_.mean_diameter, 100 * recoil(marks_.opened_diameter, profile_.mean_diameter),
                        1e3 * gain.narrowest_after, 1e3 * gain.narrowest_before, 100 * gain.residual_stenosis(),
                        scene_->solids.steps, steps, watch_.wall()));
    }

    const deck::Case& config_;
    DeployStage stage_;
    Stopwatch watch_;
    std::unique_ptr<DeployScene> scene_;
    DeployProgram program_;
    DeployPace pace_{1, 1};
    double done_ = 0, skipped_ = 0;   // of the program, to its last row [s]
    DeployRest rest_;
    SolidPart *stent_ = nullptr, *wall_ = nullptr;   // wherever they are
    std::unique_ptr<DeployContacts> contacts_;
    DeployPhase phase_ = DeployPhase::crimp;
    StentProfile profile_;
    DeployMarks marks_;
    std::unique_ptr<DeployRecord> record_;
    std::vector<double> contact_steps_;   // of the phases that have begun: what their contacts are as stiff for [s]
    CheckpointOrigin origin_;
    std::filesystem::path checkpoint_;
    double last_checkpoint_wall_ = 0, last_checkpoint_ = 0;   // s
    std::int64_t steps_before_ = 0;                           // that an interrupted run did
    bool is_resumed_ = false;
};

}   // namespace

bool deploy_by_contact(const deck::Case& config, const DeployStage& stage) { return Deployment(config, stage).run(); }

}   // namespace patency
