// Small parts of the program: quoting, names of mappers, interruption.
#include "command.h"
#include "interruption.h"
#include "machine.h"
#include "mapper_names.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace brume::app;

TEST(ShellWord, IsTakenBackByAShell)
{
  for (const std::string word : { "plain-1.nii.gz", "", "two words", "it's", "a\nb", "$HOME", "`x`",
         "\"q\"", "a\\b", "*", "~", "#", "naïve", "a;b" })
  {
    FILE* shell = popen(("printf %s " + shell_word(word)).c_str(), "r");
    ASSERT_NE(nullptr, shell);
    std::string back;
    for (int c; (c = std::fgetc(shell)) != EOF;)
    {
      back.push_back(static_cast<char>(c));
    }
    EXPECT_EQ(0, pclose(shell));
    EXPECT_EQ(word, back) << shell_word(word);
  }
  EXPECT_EQ("plain-1.nii.gz", shell_word("plain-1.nii.gz"));
}

TEST(MapperNames, AreFoundByTheirNames)
{
  for (const MapperName& mapper : mapper_names())
  {
    EXPECT_EQ(mapper.kind, find_mapper(mapper.name, "--mapper").kind);
    EXPECT_NE(std::string::npos, list_mapper_names().find(mapper.name));
  }
  try
  {
    find_mapper("nonsense", "--mapper");
    FAIL();
  }
  catch (const Failure& failure)
  {
    EXPECT_EQ(BadCall, failure.Status);
    EXPECT_NE(std::string::npos, std::string(failure.what()).find("--mapper nonsense"));
  }
}

TEST(Interruption, TheFirstSignalIsNotedAndEndsTheWork)
{
  for (const int signal : { SIGINT, SIGTERM })
  {
    const InterruptionWatch watch;
    EXPECT_NO_THROW(InterruptionWatch::check("here"));
    std::raise(signal);
    EXPECT_TRUE(InterruptionWatch::requested());
    EXPECT_THROW(InterruptionWatch::check("here"), Failure);
  }
  EXPECT_FALSE(InterruptionWatch::requested()) << "it outlives its watch";
}

TEST(InterruptionDeathTest, TheSecondSignalEndsAtOnce)
{
  const auto both = [](int first, int second)
  {
    const InterruptionWatch watch;
    std::raise(first);
    std::raise(second);
    std::exit(0);
  };
  EXPECT_EXIT(both(SIGINT, SIGINT), testing::KilledBySignal(SIGINT), "");
  EXPECT_EXIT(both(SIGINT, SIGTERM), testing::KilledBySignal(SIGTERM), "");
}
