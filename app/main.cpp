// SPDX-License-Identifier: Apache-2.0
// Arguments in, exit code out. Commands stand in files of their own (commands.h).
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "commands.h"

namespace {

int run(int argc, char** argv) {
    using namespace patency;
    ExitCode exit_code = ExitCode::ok;
    CLI::App program("Blood flow in a coronary artery by particle methods. Not a medical device.", "patency");
    program.require_subcommand(1);
    app::add_check_command(program, exit_code);
    app::add_flow_command(program, exit_code);
    app::add_schema_command(program, exit_code);
    app::add_version_command(program, exit_code);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = program.exit(error);   // prints help or what is wrong
        return code == 0 ? 0 : int(ExitCode::usage);
    }
    return int(exit_code);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const patency::Error& error) {
        std::fprintf(stderr, "patency: %s\n", error.what());
        return int(error.code());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "patency: not enough memory; use a larger numerics.spacing (patency check says what is needed)\n");
        return int(patency::ExitCode::geometry);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "patency: %s\n", error.what());
        return 1;
    }
}
