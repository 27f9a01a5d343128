// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "optionNames.h"
#include "osd_shading/errors.h"

namespace osd_shading::tool {

// What the command lines of the programs share: options of one word out of a list, or of one number.

/// What was typed can't be done; says which option is at fault.
class UsageError : public Error {
public:
    using Error::Error;
};

[[noreturn]] inline void Refuse(std::string const& option, std::string const& text) {
    throw UsageError(option + ": " + text);
}

// CLI11 would read "010" as eight and "0x10" as sixteen; the program's numbers are decimal.
template <typename T>
std::optional<T> ParseNumber(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    T number{};
    char const* const end = text.data() + text.size();
    auto const [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end) return std::nullopt;
    return number;
}

/// Adds an option that takes one of `names`.
template <typename T, std::size_t N>
CLI::Option* AddChoice(CLI::App& app, std::string const& option, std::optional<T>& target,
                       OptionNames<T, N> const& names, std::string const& help) {
    std::string words;
    for (auto const& [name, value] : names) words += (words.empty() ? "" : "|") + std::string(name);
    auto const read = [=, &target, &names](std::string const& text) {
        for (auto const& [name, value] : names) {
            if (name == text) {
                target = value;
                return;
            }
        }
        Refuse(option, "'" + text + "' is not one of " + words);
    };
    return app.add_option_function<std::string>(option, read, help)->type_name(words);
}

/// Adds an option that takes a number for which `isAllowed` holds; `words` says which those are.
template <typename T, typename Predicate>
CLI::Option* AddNumber(CLI::App& app, std::string const& option, std::optional<T>& target, std::string const& words,
                       Predicate isAllowed, std::string const& help) {
    auto const read = [=, &target](std::string const& text) {
        target = ParseNumber<T>(text);
        if (!target || !isAllowed(*target)) Refuse(option, "'" + text + "' is not " + words);
    };
    return app.add_option_function<std::string>(option, read, help)->type_name("NUMBER");
}

template <typename T>
void Replace(T& value, std::optional<T> const& given) {
    if (given) value = *given;
}

}  // namespace osd_shading::tool
