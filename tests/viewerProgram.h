// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// What the viewer's tests share: the program run as people run it, or its pictures made here; and pictures as
/// numbers.

#include <gtest/gtest.h>
#include <stb_image.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "tests/ioFiles.h"
#include "tests/programRun.h"
#include "viewer/imageMaker.h"

namespace viewerTest {

using programRun::ModelPath;
using programRun::Outcome;
using programRun::Quoted;
using programRun::Words;

inline Outcome RunViewer(Words const& words) {
    // No display: whatever needs one must not be touched.
    std::string command = "env -u DISPLAY -u WAYLAND_DISPLAY " + Quoted(OSD_SHADING_VIEWER_PROGRAM);
    for (std::string const& word : words) command += " " + Quoted(word);
    return programRun::RunShell(command);
}

struct Color {
    int red = 0, green = 0, blue = 0;

    bool operator==(Color const&) const = default;
    /// The largest difference in a channel.
    int Distance(Color const& other) const {
        return std::max({std::abs(red - other.red), std::abs(green - other.green), std::abs(blue - other.blue)});
    }
};

inline constexpr Color kWhite{255, 255, 255};

/// A PNG that is read; rows from the top.
class Picture {
public:
    Picture() = default;
    explicit Picture(std::string const& file) {
        int channels = 0;
        std::unique_ptr<stbi_uc, void (*)(void*)> const data(
            stbi_load(file.c_str(), &_width, &_height, &channels, 3), stbi_image_free);
        if (!data) {
            ADD_FAILURE() << file << " is no picture";
            return;
        }
        _pixels.assign(data.get(), data.get() + 3 * _width * _height);
    }

    explicit Picture(osd_shading::viewer::Image const& image)
        : _width(image.size.x), _height(image.size.y), _pixels(image.pixels) {}

    int Width() const { return _width; }
    int Height() const { return _height; }
    Color At(int x, int y) const {
        auto const i = 3 * static_cast<std::size_t>(y * _width + x);
        return {_pixels[i], _pixels[i + 1], _pixels[i + 2]};
    }
    template <typename Predicate>
    int Count(Predicate const& predicate) const {
        int count = 0;
        for (int y = 0; y < _height; ++y) {
            for (int x = 0; x < _width; ++x) count += predicate(At(x, y)) ? 1 : 0;
        }
        return count;
    }
    int NumCovered() const {
        return Count([](Color const& c) { return c != kWhite; });
    }
    int NumNear(Color const& color, int tolerance) const {
        return Count([&](Color const& c) { return c.Distance(color) <= tolerance; });
    }

private:
    int _width = 0, _height = 0;
    std::vector<std::uint8_t> _pixels;
};

/// Number of pixels in which two pictures of one size differ by more than `tolerance`.
inline int NumDifferent(Picture const& a, Picture const& b, int tolerance) {
    EXPECT_EQ(a.Width(), b.Width());
    EXPECT_EQ(a.Height(), b.Height());
    int count = 0;
    for (int y = 0; y < a.Height(); ++y) {
        for (int x = 0; x < a.Width(); ++x) count += a.At(x, y).Distance(b.At(x, y)) > tolerance ? 1 : 0;
    }
    return count;
}

/// Runs the program for a picture; fails the test where it does.
inline Picture DrawByProgram(Words words) {
    ioFiles::TemporaryFolder const folder;
    std::string const file = folder.File("picture.png");
    words.insert(words.end(), {"--image", file});
    Outcome const outcome = RunViewer(words);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_EQ(folder.NumFiles(), 1U) << "a temporary file is left";
    return outcome.status == 0 ? Picture(file) : Picture();
}

/// Makes pictures in this process, of the words that the program would take: it would set up its graphics and
/// compile its shaders for each. That both make the same is a test of its own.
class Drawing : public testing::Environment {
public:
    /// Before main returns: the driver has an end of its own.
    void TearDown() override { _maker.reset(); }

    static Picture Draw(Words words) {
        words.insert(words.end(), {"--image", "picture.png"});
        try {
            auto const line = osd_shading::viewer::ParseCommandLine(words);
            if (!_maker) _maker = std::make_unique<osd_shading::viewer::ImageMaker>();
            return Picture(_maker->Make(*line, [](std::string const& warning) { ADD_FAILURE() << warning; }));
        } catch (std::exception const& error) {
            ADD_FAILURE() << error.what();
            return {};
        }
    }

private:
    static inline std::unique_ptr<osd_shading::viewer::ImageMaker> _maker;
};

inline Picture Draw(Words const& words) { return Drawing::Draw(words); }

}  // namespace viewerTest
