// Simulations of DIRSIG become simulation texts.
#include <cmath>

#include "base/files.h"
#include "formats/motion/motion.h"
#include "formats/tle/tle.h"
#include "support/dirsig_kit.h"
#include "support/temp_folder.h"

namespace suite::format_dirsig_simulation_test {

namespace {

class DirsigSimulation : public testing::Test {
 protected:
  DirsigSimulation() { std::filesystem::copy(kDirsigData, folder_.path(), std::filesystem::copy_options::recursive); }
  void change(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = read_text(folder_ / name);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / name, std::string_view(text.replace(at, from.size(), to)));
  }
  Params read(const std::string& name) {
    import_ = std::make_unique<dirsig::Import>(std::vector<std::string>{}, folder_.path());
    const dirsig::SimulationHelp help = dirsig_help();
    const dirsig::MadeText made = dirsig::simulation_of(*import_, folder_ / name, help);
    expect_accounted(import_->ledger());
    return params_of(made, folder_ / name);
  }
  static Params array(const Params& root) {
    return root.at("sensors")[0].at("attachments")[0].at("attachments")[0].at("instruments")[0].at("arrays")[0];
  }
  TempFolder folder_;
  std::unique_ptr<dirsig::Import> import_;
};

TEST_F(DirsigSimulation, UniformAirIsASunThatIsFaced) {
  const Params root = read("plane.jsim");
  EXPECT_EQ(root.text("scene"), "plane.h5");
  EXPECT_EQ(root.at("sun").number("irradiance"), 2000);  // 0.2 W/(cm2 um)
  EXPECT_EQ(root.at("sun").at("direction").number("zenith_deg"), 60);
  EXPECT_FALSE(root.has("sky"));
  EXPECT_EQ(root.at("sensors")[0].text("name"), "fixed_plane");
}

TEST_F(DirsigSimulation, AShareOfUniformAirIsSky) {
  change("uniform.atm", "<skyfraction>0<", "<skyfraction>0.25<");
  const Params root = read("plane.jsim");
  EXPECT_EQ(root.at("sun").number("irradiance"), 1500);
  EXPECT_NEAR(root.at("sky").number("radiance"), 500 / std::acos(-1.0), 1e-9);
}

TEST_F(DirsigSimulation, DatesCountFromTheTasks) {
  const Params root = read("plane.sim");
  EXPECT_EQ(root.text("epoch"), "2009-07-27T19:29:32.000Z");
  EXPECT_EQ(root.at("sun").at("direction").text("time_utc"), "2009-07-27T19:29:32.000Z");
}

TEST_F(DirsigSimulation, OtherAirIsComputedAndToldApart) {
  change("plane.sim", "uniform.atm", "simple.atm");
  const Params root = read("plane.sim");
  EXPECT_EQ(root.at("atmosphere").text("profile"), "us_standard");
  EXPECT_EQ(fate_of(import_->ledger(), "simpleradiativetransfer"), "approximated");
  write_file(folder_ / "simple.atm",
             std::string_view("<atmosphericconditions><classicradiativetransfer><tape5filename>a.tp5</tape5filename>"
                              "</classicradiativetransfer></atmosphericconditions>"));
  write_file(folder_ / "a.tp5", std::string_view("x"));
  const Params classic = read("plane.sim");
  EXPECT_EQ(classic.at("atmosphere").text("profile"), "tropical");
  EXPECT_EQ(classic.at("atmosphere").at("aerosol").number("visibility_km"), 5);
}

TEST_F(DirsigSimulation, ResponsesAreAbsolute) {
  const Params bands = array(read("plane.sim")).at("bands");
  ASSERT_EQ(bands.size(), 3u);
  // A width is a standard deviation, and the peak that of the standard normal density.
  const std::vector<double> x = bands[1].at("response").at("wavelength_um").as_numbers(),
                            y = bands[1].at("response").at("value").as_numbers();
  EXPECT_NEAR(x[128], 0.7, 1e-12);
  EXPECT_NEAR(y[128], 0.398942, 1e-6);
  double area = 0;
  for (size_t i = 1; i < x.size(); ++i) area += (y[i] + y[i - 1]) / 2 * (x[i] - x[i - 1]);
  EXPECT_NEAR(area, 0.03, 0.03 * 1e-4);
}

TEST_F(DirsigSimulation, RadianceSaysItsFactor) {
  change("camera.platform", "electronspersecond", "watts");
  change("camera.platform", "<aperturediameter>0.05</aperturediameter>", "");
  const Params root = read("plane.sim");
  EXPECT_FALSE(array(root).has("detector"));
  std::string note;
  for (const dirsig::Entry& e : import_->ledger().entries())
    if (e.path.ends_with("channellist/channel") && note.empty()) note = e.note;
  EXPECT_NE(note.find("DIRSIG's value is 0.001 times it"), std::string::npos) << note;  // 0.1 um in 0.01 s
}

// Electrons are what is asked for; counts need a detector model that says how many electrons one is.
TEST_F(DirsigSimulation, CountsNeedADetectorModel) {
  const auto detector = [&] { return array(read("plane.sim")).at("detector"); };
  EXPECT_EQ(detector().number("quantum_efficiency"), 1);
  EXPECT_FALSE(detector().has("gain_e_per_dn"));
  const std::string sizeless = "<detectormodel><quantumefficiency>0.5</quantumefficiency><bitdepth>12</bitdepth>";
  change("camera.platform", "</capturemethod>", sizeless + "</detectormodel></capturemethod>");
  EXPECT_EQ(detector().number("quantum_efficiency"), 0.5);
  EXPECT_FALSE(detector().has("gain_e_per_dn"));
  EXPECT_EQ(fate_of(import_->ledger(), "detectormodel/bitdepth"), "unsupported");
  change("camera.platform", sizeless, sizeless + "<minelectrons>0</minelectrons><maxelectrons>8190</maxelectrons>");
  EXPECT_EQ(detector().number("gain_e_per_dn"), 2);  // 8190 electrons in 2^12 - 1 steps
}

TEST_F(DirsigSimulation, OneRowWithAClockIsAStrip) {
  change("camera.platform", "<yelementcount>6<", "<yelementcount>1<");
  const Params line = array(read("plane.sim")).at("readout");
  EXPECT_EQ(line.text("kind"), "line");
  EXPECT_EQ(line.number("line_rate_hz"), 1);
}

TEST_F(DirsigSimulation, PatternsOfColoursAreTold) {
  change("camera.platform", "</channellist>",
         "</channellist><channelpattern name=\"bayer\"><red>box</red></channelpattern>");
  read("plane.sim");
  EXPECT_EQ(fate_of(import_->ledger(), "channelpattern"), "approximated");
  EXPECT_EQ(fate_of(import_->ledger(), "channelpattern/red"), "approximated");
}

TEST_F(DirsigSimulation, MountsTurn) {
  change("camera.platform", "<zrotation>0</zrotation></data>", "<zrotation>1.5707963267948966</zrotation></data>");
  const Params mount = read("plane.sim").at("sensors")[0].at("attachments")[0].at("mount");
  EXPECT_NEAR(mount.at("rotate_deg").as_numbers()[2], 90, 1e-9);
  change("camera.platform", "mount type=\"static\"", "mount type=\"lemniscate\"");
  read("plane.sim");
  EXPECT_EQ(fate_of(import_->ledger(), "mount/@type"), "unsupported");
}

TEST_F(DirsigSimulation, FlexibleMotionFliesAndLooks) {
  write_file(
      folder_ / "nadir.ppd",
      std::string_view("<platformmotion type=\"flexible\"><locationengine type=\"straight\"><heading>90</heading>"
                       "<velocity>100</velocity><start><location type=\"scene\"><point><x>1</x><y>2</y><z>3000</z>"
                       "</point></location></start></locationengine><orientationengine type=\"lookat\"><location "
                       "type=\"scene\"><point><x>0</x><y>0</y><z>0</z></point></location></orientationengine>"
                       "<orientationjitter angularunits=\"radians\"><x><sigma>1e-6</sigma><mean>0</mean></x>"
                       "</orientationjitter></platformmotion>"));
  const Params sensor = read("plane.sim").at("sensors")[0];
  EXPECT_EQ(sensor.at("motion").text("kind"), "straight");
  EXPECT_EQ(sensor.at("motion").at("pointing").at("look_at").at("position_m").as_numbers()[2], 0);
  EXPECT_EQ(sensor.at("jitter").at("rotate_x").number("sigma_rad"), 1e-6);
}

// Every engine of location with every one of orientation is a track that our reader takes.
TEST_F(DirsigSimulation, EveryFlexibleMotionIsATrack) {
  const std::string place = "<location type='scene'><point><x>1</x><y>2</y><z>3000</z></point></location>";
  const std::string locations[] = {
      "'fixed'>" + place,
      "'straight'><heading>90</heading><velocity>10</velocity><start>" + place + "</start>",
      "'circling'><radius>100</radius><velocity>10</velocity><center>" + place + "</center>",
      "'waypoints'><data source='internal' datetime='relative' frame='geodetic' "
      "delimiter=','>0,39,-120,3000\n10,39.001,-120,"
      "3000</data>",
      "'waypoints'><data source='internal' frame='scene'>0 0 0 3000\n10 0 100 3000</data>",
      "'sgp4'><tle1>1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927</tle1><tle2>2 25544  51.6416 "
      "247.4627 0006703 130.5360 325.0288 15.72125391563537</tle2>"};
  const std::string orientations[] = {
      "'euler'><data source='internal' angularunits='degrees'>0 0 0 90\n10 0 0 180</data>",
      "'quaternions'><data source='internal'>0 1 0 0 0\n10 1 0 0 0</data>", "'velocity'>",
      "'lookat'><location type='scene'><point><x>0</x><y>5</y><z>0</z></point></location>",
      "'spin'><axis><x>0</x><y>0</y><z>1</z></axis><rate>5</rate>"};
  MotionContext context;
  context.frame.emplace(Geodetic{39, -120, 0});
  context.clock.emplace(parse_iso8601("2009-07-27T19:29:32Z"));
  context.satellite_lines = [](const std::string& lines, const std::string& file) {
    return parse_tle(lines, file).at(0).elements;
  };
  for (const std::string& location : locations)
    for (const std::string& orientation : orientations) {
      write_file(folder_ / "nadir.ppd", std::string_view("<motion type='flexible'><locationengine type=" + location +
                                                         "</locationengine><orientationengine type=" + orientation +
                                                         "</orientationengine></motion>"));
      const Params motion = read("plane.sim").at("sensors")[0].at("motion");
      const bool rests = location.starts_with("'fixed'") && orientation.starts_with("'velocity'");
      const TrackPtr track = track_from(motion, context);
      if (rests) continue;  // it has no way to look along
      const Vec3 at = track->at(5).translation;
      if (location.starts_with("'sgp4'"))
        EXPECT_NEAR(length(context.frame->ecef_from_enu(at)), 6.73e6, 3e4) << orientation;
      else
        EXPECT_NEAR(at.z, 3000, 1) << location << orientation;
    }
}

TEST_F(DirsigSimulation, PlacesOnTheEarthKeepTheirFrames) {
  change("nadir.ppd", "<location type=\"scene\"><point><x>0</x><y>0</y><z>1000</z></point></location>",
         "<location "
         "type=\"geodetic\"><latitude>39</latitude><longitude>-120</longitude><altitude>1000</altitude></location>");
  const Params motion = read("plane.sim").at("sensors")[0].at("motion");
  EXPECT_EQ(motion.number("latitude_deg"), 39);
  EXPECT_EQ(motion.number("height_m"), 1000);
}

TEST_F(DirsigSimulation, ScenesAreShifted) {
  change("plane.jsim", "\"0,0,0\"", "\"10,0,-2\"");
  const Params scenes = read("plane.jsim").at("scenes");
  EXPECT_EQ(scenes[0].at("translate").as_numbers(), (std::vector<double>{10, 0, -2}));
}

}  // namespace

}  // namespace suite::format_dirsig_simulation_test
