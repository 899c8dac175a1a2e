// SPDX-License-Identifier: Apache-2.0
// The manual page and the shell's completion say what --help says.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "tests/app/program.h"

namespace patency {
namespace {

std::set<std::string> matches(const std::string& text, const char* pattern) {
    const std::regex expression(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) found.insert((*at)[1]);
    return found;
}

std::set<std::string> commands() {
    const std::string help = patency("--help").output;
    return matches(help.substr(help.find("Subcommands:")), "\n  ([a-z]+) ");
}

TEST(Documents, TheManualHasEveryCommandAndOption) {
    const Result man = patency("man");
    ASSERT_EQ(man.exit_code, 0);
    std::string plain = man.output;
    for (std::size_t at = plain.find("\\-"); at != plain.npos; at = plain.find("\\-", at)) plain.erase(at, 1);
    ASSERT_GT(commands().size(), 10u);
    for (const std::string& command : commands()) {
        EXPECT_NE(plain.find(".SS patency " + command), plain.npos) << command;
        const std::set<std::string> options = matches(patency(command + " --help").output, "(--[a-z]+)");
        for (const std::string& option : options)
            if (option != "--help") {
                EXPECT_NE(plain.find(option), plain.npos) << command << ' ' << option;
            }
    }
    EXPECT_NE(plain.find("143"), plain.npos);
}

TEST(Documents, NoLineOfTheManualIsTakenForARequest) {
    static const std::set<std::string> requests{".TH", ".SH", ".SS", ".TP", ".B", ".I"};
    std::istringstream lines(patency("man").output);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && (line[0] == '.' || line[0] == '\'')) {
            EXPECT_TRUE(requests.count(line.substr(0, line.find(' ')))) << line;
        }
}

/// What bash offers in an empty folder for words of which the last is being written.
std::string offered(const std::string& words, int at) {
    const std::string script = fmt::format("cd $(mktemp -d); trap 'rmdir $PWD' EXIT; source <('{}' completion bash); COMP_WORDS=({}); COMP_CWORD={}; _patency; echo \"${{COMPREPLY[*]}}\"", PATENCY_BINARY, words, at);
    std::FILE* pipe = popen(fmt::format("bash -c {}", "'" + std::regex_replace(script, std::regex("'"), "'\\''") + "'").c_str(), "r");
    std::string output;
    char chunk[4096];
    while (const std::size_t n = std::fread(chunk, 1, sizeof chunk, pipe)) output.append(chunk, n);
    EXPECT_EQ(pclose(pipe), 0) << script;
    return output;
}

TEST(Documents, BashCompletesCommandsOptionsAndFiles) {
    EXPECT_EQ(offered("patency es", 1), "estimate\n");
    EXPECT_EQ(offered("patency flow a.yaml --thr", 3), "--threads\n");
    EXPECT_EQ(offered("patency stent li", 2), "list\n");
    EXPECT_NE(offered("patency check /et", 2).find("/etc"), std::string::npos);
    const std::string all = offered("patency \"\"", 1);
    for (const std::string& command : commands()) EXPECT_NE(all.find(command), all.npos) << command;
}

}   // namespace
}   // namespace patency
