// SUMO's floating car data: places and headings of what moves, gaps, frames of networks, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/motion/track_files.h"
#include "support/message_of.h"

namespace suite::format_motion_fcd_test {
namespace {

using testing::HasSubstr;

const char* kFile = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- generated -->
<fcd-export xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
    <timestep time="25200.00">
        <vehicle id="a" x="10.00" y="5.00" angle="90.00" type="car" speed="13.9" pos="5.1" lane="e_0" slope="0.00"/>
    </timestep>
    <timestep time="25201.00">
        <vehicle id="a" x="23.90" y="5.00" angle="90.00" type="car" speed="13.9" pos="19" lane="e_0" slope="0.00"/>
        <vehicle id="b" x="0.00" y="0.00" z="2.5" angle="350.00" type="bus" speed="0" pos="0" lane="f_0" slope="10"/>
        <person id="a" x="1.00" y="1.00" angle="0.00" speed="1.00" pos="1" edge="e" slope="0.00"/>
    </timestep>
    <timestep time="25202.00">
        <vehicle id="b" x="0.00" y="0.00" z="2.5" angle="10.00" type="bus" speed="0" pos="0" lane="f_0" slope="10"/>
    </timestep>
    <timestep time="25203.00">
        <vehicle id="a" x="50.00" y="5.00" angle="90.00" type="car" speed="13.9" pos="45" lane="e_0" slope="0.00"/>
    </timestep>
</fcd-export>
)";

std::vector<MovingThing> read(const std::string& text, const TrackFileOptions& options) {
  const TrackFileRow* row = track_file_of(text);
  if (!row) throw Error("nobody knows it");
  return row->make(text, "f.xml", options);
}

TEST(Fcd, ThingsAreWhereTheirRecordsSay) {
  const MotionContext context;
  TrackFileOptions options{context};
  options.begins = -25200, options.east = 100, options.height = 0.25;
  const auto things = read(kFile, options);
  ASSERT_EQ(things.size(), 4u);
  EXPECT_EQ(things[0].id, "a");
  EXPECT_EQ(things[0].type, "car");
  EXPECT_EQ(things[0].where.line, 5);
  EXPECT_EQ(things[0].track->covered().begin, 0);
  EXPECT_EQ(things[0].track->covered().end, 1);
  EXPECT_NEAR(length(things[0].track->at(1).translation - Vec3{123.9, 5, 0.25}), 0, 1e-12);
  // Heading east: forward (y) is ENU x.
  EXPECT_NEAR(length(things[0].track->at(0).vector({0, 1, 0}) - Vec3{1, 0, 0}), 0, 1e-12);
  // The bus climbs with its nose to the north, 10 degrees to the west of it and then 10 to the east.
  const Vec3 nose = things[1].track->at(1).vector({0, 1, 0});
  EXPECT_NEAR(nose.z, std::sin(10 * kDegree), 1e-12);
  EXPECT_NEAR(nose.x, -std::cos(10 * kDegree) * std::sin(10 * kDegree), 1e-12);
  EXPECT_NEAR(things[1].track->at(1).translation.z, 2.75, 1e-12);
  // A person of the same id is somebody else, and one who misses a step comes back as another thing.
  EXPECT_EQ(things[2].type, "person");
  EXPECT_EQ(things[3].id, "a");
  EXPECT_EQ(things[3].type, "car");
  EXPECT_EQ(things[3].track->covered().begin, 3);
}

// SUMO's --human-readable-time: hours:minutes:seconds, with days before them from the first whole day on.
TEST(Fcd, TimesForPeople) {
  const MotionContext context;
  const auto at = [&](const std::string& time) {
    return read("<fcd-export><timestep time=\"" + time +
                    "\"><vehicle id=\"a\" x=\"1\" y=\"2\" angle=\"0\"/></timestep></fcd-export>",
                {context})[0]
        .track->covered()
        .begin;
  };
  EXPECT_EQ(at("00:00:00"), 0);
  EXPECT_EQ(at("07:00:01.50"), 7 * 3600 + 1.5);
  EXPECT_EQ(at("2:03:04:05"), ((2 * 24 + 3) * 60 + 4) * 60 + 5);
  EXPECT_EQ(at("-00:01:00"), -60);
  for (const char* wrong :
       {"07:00", "1:2:3:4:5", "00:60:00", "00:00:61", "1:24:00:00", "00:1.5:00", "00::00", "a:b:c", "00:00:", ":"})
    EXPECT_THAT(message_of([&] { at(wrong); }), HasSubstr("is no time")) << wrong;
}

TEST(Fcd, NetworksOnTheEarth) {
  const SceneFrame frame({48.5, 9.1, 400});
  const MotionContext context{frame, {}, 0, nullptr};
  const Geodetic place{48.501, 9.102, 410};
  const UtmZone zone = standard_utm_zone(place);
  const UtmPoint grid = utm_from_geodetic(place, zone);
  const auto file = [](double x, double y) {
    return strf(
        "<fcd-export><timestep time=\"0\"><vehicle id=\"a\" x=\"%.12g\" y=\"%.12g\" angle=\"0\" "
        "type=\"t\"/></timestep></fcd-export>",
        x, y);
  };
  TrackFileOptions options{context};
  options.height = 410;
  options.network = TrackFileOptions::Network::geographic;
  const Pose at = read(file(9.102, 48.501), options)[0].track->at(0);
  EXPECT_NEAR(length(at.translation - frame.enu_from_geodetic(place)), 0, 1e-4);
  options.network = TrackFileOptions::Network::utm;
  options.zone = zone, options.east = 400000, options.north = 5000000;
  const Pose there = read(file(grid.easting - 400000, grid.northing - 5000000), options)[0].track->at(0);
  EXPECT_NEAR(length(there.translation - at.translation), 0, 1e-4);
  // Grid north is not true north.
  EXPECT_NEAR(angle_between(there.vector({0, 1, 0}), rotate(utm_axes(frame, grid), {0, 1, 0})), 0, 1e-7);
  EXPECT_GT(angle_between(there.vector({0, 1, 0}), at.vector({0, 1, 0})), 1e-4);
}

TEST(Fcd, FaultsAreToldWithTheirLine) {
  const MotionContext context;
  const auto told = [&](std::string from, const std::string& to) {
    std::string text = kFile;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    try {
      read(text, {context});
    } catch (const Error& e) {
      return strf("%d: ", e.where().line) + e.message();
    }
    return std::string("nothing");
  };
  EXPECT_THAT(told("x=\"23.90\"", "x=\"far\""), HasSubstr("8: x=\"far\" is no number"));
  EXPECT_THAT(told("x=\"23.90\"", "x=\"nan\""), HasSubstr("8: x=\"nan\" is no number"));
  EXPECT_THAT(told("x=\"23.90\" ", ""), HasSubstr("8: no x"));
  EXPECT_THAT(told("x=\"23.90\"", "x=\"1e300\""), HasSubstr("8: a position inf m away"));
  EXPECT_THAT(told("25202.00", "25201.00"), HasSubstr("12: the times do not ascend"));
  EXPECT_THAT(told("vehicle id=\"b\"", "vehicle id=\"a\""), HasSubstr("9: 'a' is there twice"));
  EXPECT_THAT(told("id=\"b\" ", ""), HasSubstr("9: vehicle without an id"));
  EXPECT_THAT(told("</timestep>", "</timestop>"), HasSubstr("no XML"));
  EXPECT_THAT(message_of([&] { read("<fcd-export></fcd-export>", {context}); }), HasSubstr("nothing moves"));
  EXPECT_THAT(message_of([&] { read("time_s,east_m\n", {context}); }), HasSubstr("nobody"));
}

}  // namespace
}  // namespace suite::format_motion_fcd_test
