#include <maximin/proofs_check/trial_file.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <maximin/proofs_check/campaign_summary.hpp>

#include "../theory/small_models.hpp"
#include "small_records.hpp"

namespace maximin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A folder of its own for every test, gone afterwards.
class TrialFiles : public testing::Test {
 protected:
  TrialFiles() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("maximin." + std::to_string(::getpid()) + "." + test->name());
    fs::create_directories(folder_);
    path_ = folder_ / "trials.jsonl";
  }
  ~TrialFiles() override { fs::remove_all(folder_); }

  static std::string contents(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  }

  /// Writes a whole run of the records.
  void write_run(const std::vector<TrialRecord>& records) const {
    TrialFile file = TrialFile::create(path_, header_);
    for (const TrialRecord& record : records) file.append(record);
  }

  std::string refusal(const Json& header) const {
    return complaint([&] { TrialFile::resume(path_, header); });
  }

  fs::path folder_, path_;
  const Json header_{{"program", "verify_bound"}, {"seed", 1}, {"family", {{"name", "mixed"}, {"eps", 0.5}}}};
};

TEST_F(TrialFiles, HoldAHeaderAndOneLineATrial) {
  const auto records = small_records(3);
  write_run(records);
  std::string expected = header_.dump() + '\n';
  for (const auto& line : lines_of(records)) expected += line + '\n';
  EXPECT_EQ(contents(path_), expected);
}

TEST_F(TrialFiles, HandEachRecordToTheSystemAtOnce) {
  const auto records = small_records(2);
  TrialFile file = TrialFile::create(path_, header_);
  const auto header_only = contents(path_);
  file.append(records[0]);
  EXPECT_EQ(contents(path_), header_only + lines_of(records)[0] + '\n') << "while the file is still open";
}

TEST_F(TrialFiles, AreNeverOverwritten) {
  write(path_, "results of last week\n");
  EXPECT_EQ(complaint([&] { TrialFile::create(path_, header_); }),
            path_.string() +
                ": File exists, expected a file that can be written; complete it with --resume, or name another file");
  EXPECT_EQ(contents(path_), "results of last week\n");
}

TEST_F(TrialFiles, CannotBeMadeWhereThereIsNoFolder) {
  const auto nowhere = folder_ / "none" / "trials.jsonl";
  EXPECT_EQ(complaint([&] { TrialFile::create(nowhere, header_); }),
            nowhere.string() + ": No such file or directory, expected a file that can be written");
  for (const fs::path& no_file : {folder_, fs::path("/dev/zero")}) {
    EXPECT_EQ(complaint([&] { TrialFile::resume(no_file, header_); }),
              no_file.string() + ": not a plain file, expected the file of an interrupted run");
  }
}

TEST_F(TrialFiles, HaveOneWriterAtATime) {
  const auto records = small_records(1, std::set{ClaimId::e_test_time});
  write_run(records);
  const auto before = contents(path_);
  TrialFile first = TrialFile::resume(path_, header_);
  EXPECT_EQ(complaint([&] { TrialFile::resume(path_, header_); }),
            path_.string() + ": another run is writing it, expected one run at a time");
  EXPECT_EQ(contents(path_), before);
}

TEST_F(TrialFiles, NestedWithoutEndAreRefused) {
  write(path_, std::string(3'000'000, '[') + "\n");
  EXPECT_EQ(complaint([&] { TrialFile::resume(path_, header_); }),
            path_.string() + ":1: nested deeper than 16 levels, expected a line written by --trials-out");
}

TEST_F(TrialFiles, NumbersOutOfRangeAreRefused) {
  const auto records = small_records(1, std::set{ClaimId::e_test_time});
  write_run(records);
  for (const char* period : {"1e300", "-7", "true", "99999999999999999999"}) {
    auto lines = lines_of(records);
    auto edited = nlohmann::ordered_json::parse(lines[0]);
    edited["period"] = nlohmann::ordered_json::parse(period);
    write(path_, header_.dump() + '\n' + edited.dump() + '\n');
    EXPECT_EQ(complaint([&] { TrialFile::resume(path_, header_); }),
              path_.string() + ":2: period: not of its kind or out of range, expected a trial record")
        << period;
  }
}

/// A kill may come between any two bytes: whatever is left, resuming gives the bytes of an uninterrupted run.
TEST_F(TrialFiles, ResumeAfterACutAtEveryByte) {
  const auto records = small_records(2, std::set{ClaimId::e_test_time});
  write_run(records);
  const std::string whole = contents(path_);
  std::size_t cuts_in_header = 0;
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    const std::string left = whole.substr(0, cut);
    write(path_, left);
    {
      TrialFile file = TrialFile::resume(path_, header_);
      const auto kept = file.finished().size();
      const auto newlines = static_cast<std::size_t>(std::count(left.begin(), left.end(), '\n'));
      ASSERT_EQ(kept, newlines == 0 ? 0 : newlines - 1) << "cut at " << cut;
      cuts_in_header += newlines == 0;
      for (std::size_t k = kept; k < records.size(); ++k) file.append(records[k]);
    }
    ASSERT_EQ(contents(path_), whole) << "cut at " << cut;
  }
  EXPECT_EQ(cuts_in_header, header_.dump().size() + 1);
}

TEST_F(TrialFiles, ResumedRecordsSummariseLikeFreshOnes) {
  const auto records = small_records(40);
  write_run(records);
  const auto resumed = TrialFile::resume(path_, header_).finished();
  EXPECT_EQ(to_json(summarise(resumed)).dump(), to_json(summarise(records)).dump());
}

TEST_F(TrialFiles, ResumeStartsAFileThatIsNotThere) {
  { TrialFile file = TrialFile::resume(path_, header_); }
  EXPECT_EQ(contents(path_), header_.dump() + '\n');
}

TEST_F(TrialFiles, RefuseToResumeAnotherCampaign) {
  write_run(small_records(1));
  const std::string before = contents(path_);
  const std::string start = path_.string() + ":1: another campaign (", end = "), expected the same options as now";
  Json other = header_;
  other["seed"] = 2;
  EXPECT_EQ(refusal(other), start + "seed is 1 there and 2 now" + end);
  other = header_;
  other["family"]["eps"] = 0.25;
  EXPECT_EQ(refusal(other), start + "eps is 0.5 there and 0.25 now" + end);
  other = header_;
  other["trials"] = 9;
  EXPECT_EQ(refusal(other), start + "it has no trials" + end);
  other = header_;
  other.erase("seed");
  EXPECT_EQ(refusal(other), start + "it has more settings" + end);
  EXPECT_EQ(contents(path_), before) << "refused files are left alone";
}

TEST_F(TrialFiles, RefuseDamageWithTheNumberOfItsLine) {
  const auto lines = lines_of(small_records(3));
  const std::string top = header_.dump() + '\n';
  const auto refused = [&](const std::string& text) {
    write(path_, text);
    const std::string message = refusal(header_);
    EXPECT_EQ(contents(path_), text) << "refused files are left alone";
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr(path_.string().size());
  };
  EXPECT_EQ(refused("nonsense\n"), ":1: not JSON, expected a line written by --trials-out");
  EXPECT_EQ(refused(top + lines[0] + "\nnonsense\n" + lines[2] + '\n'),
            ":3: not JSON, expected a line written by --trials-out");
  EXPECT_EQ(refused(top + lines[0].substr(0, 40) + '\n'), ":2: not JSON, expected a line written by --trials-out");
  EXPECT_EQ(refused(top + lines[1] + '\n'), ":2: trial 1, expected trial 0");
  EXPECT_EQ(refused(top + lines[0] + '\n' + lines[2] + '\n'), ":3: trial 2, expected trial 1");
  EXPECT_EQ(refused(top + lines[0] + '\n' + lines[0] + '\n'), ":3: trial 0, expected trial 1");
  const std::string no_record = refused(top + "{\"trial\":0}\n");
  EXPECT_EQ(no_record.rfind(":2: ", 0), 0u) << no_record;
  EXPECT_NE(no_record.find(", expected a trial record"), std::string::npos) << no_record;
  EXPECT_NE(refused(top + '\n'), "");
}

/// No file may grow beyond what it is now, which is how a full disk looks from here.
class NoRoom {
 public:
  explicit NoRoom(std::uintmax_t bytes) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit tight{static_cast<rlim_t>(bytes), limit_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &tight);
  }
  ~NoRoom() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
  }
  NoRoom(const NoRoom&) = delete;
  NoRoom& operator=(const NoRoom&) = delete;

 private:
  void (*before_)(int);
  rlimit limit_{};
};

TEST_F(TrialFiles, SayThatThereIsNoRoomAndCanBeResumed) {
  const auto records = small_records(3);
  write_run(records);
  const std::string whole = contents(path_);
  fs::remove(path_);
  {
    TrialFile file = TrialFile::create(path_, header_);
    file.append(records[0]);
    const NoRoom full(fs::file_size(path_) + 20);
    EXPECT_EQ(complaint([&] { file.append(records[1]); }),
              path_.string() + ": File too large, expected room for the results; free some and use --resume");
    TrialFile abandoned = std::move(file);  // closed while the disk is still full
  }
  TrialFile file = TrialFile::resume(path_, header_);
  ASSERT_EQ(file.finished().size(), 1u);
  for (std::size_t k = 1; k < 3; ++k) file.append(records[k]);
  EXPECT_EQ(contents(path_), whole);
}

}  // namespace
}  // namespace maximin
