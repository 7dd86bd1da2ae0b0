// Scene files and the options of the command line: one list of keys, and a schema that says the same.
#include "option_checks.h"
#include "scene_file.h"
#include "scene_options.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <set>
#include <sstream>

using namespace brume::app;

namespace
{

std::string text_of(const std::string& path)
{
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}

TEST(SceneSchema, IsWhatTheDocumentationHolds)
{
  const std::string now = scene_schema().dump(2) + "\n";
  const std::string held = text_of(BRUME_SOURCE_FOLDER "/docs/user/scene.schema.json");
  if (now != held)
  {
    const std::string path = BRUME_TEST_OUTPUT "/scene.schema.json";
    std::ofstream(path) << now;
    FAIL() << "docs/user/scene.schema.json is not what the options say: copy " << path;
  }
}

TEST(SceneSchema, NamesEveryOptionOfAScene)
{
  CLI::App command;
  SceneOptions options;
  add_scene_options(command, options, "preset");
  std::set<std::string> keys{ "$schema", "lights", "lobes", "colour", "opacity", "exposure",
    "display-curve" };
  for (const CLI::Option* option : command.get_options())
  {
    const std::string name = option->get_positional() ? "input" : option->get_lnames().at(0);
    if (name != "help" && name != "scene")
    {
      keys.insert(name);
    }
  }
  std::set<std::string> found;
  const nlohmann::ordered_json schema = scene_schema();
  for (const auto& [name, value] : schema["properties"].items())
  {
    EXPECT_TRUE(value.contains("description") && !value["description"].get<std::string>().empty())
      << name;
    EXPECT_TRUE(value.contains("type") || value.contains("anyOf") || value.contains("enum")) << name;
    found.insert(name);
  }
  EXPECT_EQ(keys, found);
  EXPECT_GT(keys.size(), 60u);
}

TEST(SceneGuide, MentionsNoOptionThatThereIsNot)
{
  CLI::App command;
  SceneOptions options;
  add_scene_options(command, options, "preset");
  const std::string guide = text_of(BRUME_SOURCE_FOLDER "/docs/user/scene-files.md");
  ASSERT_FALSE(guide.empty());
  const std::set<std::string> others{ "--output", "--stats", "--mapper" }; // of subcommands
  int mentioned = 0;
  for (std::size_t at = guide.find("`--"); at != std::string::npos; at = guide.find("`--", at + 1))
  {
    const std::string name = guide.substr(at + 1, guide.find_first_of("` ", at + 1) - at - 1);
    EXPECT_TRUE(others.count(name) || command.get_option_no_throw(name)) << name;
    ++mentioned;
  }
  EXPECT_GT(mentioned, 10);
}

TEST(NearestName, IsTheOneThatWasMeant)
{
  const std::vector<std::string> names{ "albedo", "anisotropy", "sky-radiance", "up" };
  EXPECT_EQ("albedo", nearest_name("albdeo", names));
  EXPECT_EQ("albedo", nearest_name("albedos", names));
  EXPECT_EQ("sky-radiance", nearest_name("sky_radiance", names));
  EXPECT_EQ("sky-radiance", nearest_name("sky", names));
  EXPECT_EQ("", nearest_name("sk", names));
  EXPECT_EQ("--sun-direction", nearest_name("--sun", { "--sample", "--sun-direction", "--sun-irradiance" }));
  EXPECT_EQ("", nearest_name("---", { "--sun-direction" }));
  EXPECT_EQ("", nearest_name("temperature", names));
  EXPECT_EQ("", nearest_name("", names));
  EXPECT_EQ("", nearest_name(std::string(100000, 'x'), names));
}

TEST(SplitNumbers, TakesNumbersAlone)
{
  EXPECT_EQ((std::vector<double>{ 1.0, -2.5, 3e4 }), split_numbers("1,-2.5,3e4"));
  for (const char* text : { "", ",", "1,", ",1", "1,,2", "1 2", "a", "nan", "1,inf", "1,2x" })
  {
    EXPECT_TRUE(split_numbers(text).empty()) << text;
  }
}
