// SPDX-License-Identifier: Apache-2.0
#include "patency/io/log_file.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>

#include <memory>
#include <utility>

#include "patency/base/errors.h"

namespace patency {
namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
        case LogLevel::debug: return spdlog::level::debug;
        case LogLevel::info: return spdlog::level::info;
        case LogLevel::warning: return spdlog::level::warn;
        case LogLevel::error: return spdlog::level::err;
    }
    return spdlog::level::info;
}

}   // namespace

Log make_file_log(const std::filesystem::path& path, LogMode mode) {
    std::shared_ptr<spdlog::logger> logger;
    try {
        auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path.string(), mode == LogMode::begin);
        logger = std::make_shared<spdlog::logger>("patency", std::move(sink));
    } catch (const spdlog::spdlog_ex& error) {
        throw FileError(fmt::format("cannot write the log: {}.", error.what()));
    }
    logger->set_level(spdlog::level::debug);
    logger->set_pattern("%Y-%m-%d %H:%M:%S %l: %v");
    logger->flush_on(spdlog::level::debug);
    logger->set_error_handler([](const std::string&) {});   // spdlog's own would print
    return [logger](LogLevel level, std::string_view message) {
        logger->log(spdlog_level(level), spdlog::string_view_t(message.data(), message.size()));
    };
}

Log make_tee_log(Log first, Log second) {
    return [first = std::move(first), second = std::move(second)](LogLevel level, std::string_view message) {
        first(level, message);
        second(level, message);
    };
}

}   // namespace patency
