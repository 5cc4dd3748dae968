// taut paper: the command and what it leaves behind, on parts that take a second.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/run_program.hpp"

namespace taut::test {
namespace {

namespace fs = std::filesystem;

TEST(PaperCommand, WritesAReportThatStandsOnItsOwn) {
  const TempFolder folder;
  const fs::path out = folder.path() / "report";
  const ProgramResult result = run_taut({"paper", "figure1", "figure2", "--out", out.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string page = file_bytes(out / "report.html");
  for (const char* heading : {">Figure 1</h2>", ">Figure 2</h2>"})
    EXPECT_NE(page.find(heading), std::string::npos) << heading;
  EXPECT_EQ(page.find(">Figure 5</h2>"), std::string::npos) << "a part that was not asked for";
  EXPECT_NE(page.find("<svg"), std::string::npos) << "figures stand in the page itself";
  // Nothing is fetched: no address but names of namespaces, and links to the files beside it.
  for (const char* fetch : {"src=\"http", "href=\"http", "url(http", "@import", "<script"}) {
    EXPECT_EQ(page.find(fetch), std::string::npos) << fetch;
  }
}

TEST(PaperCommand, WritesEveryFigureAndEveryTableAsFiles) {
  const TempFolder folder;
  ASSERT_EQ(run_taut({"paper", "figure2", "--out", folder.path().string()}).exit_code, 0);
  const std::string svg = file_bytes(folder.path() / "figures" / "figure2_vector_triangle.svg");
  EXPECT_TRUE(svg.starts_with("<svg"));
  const fs::path png = folder.path() / "figures" / "figure2_vector_triangle.png";
  if (fs::exists(png)) {  // drawn by Cairo, which may be left out of a build
    EXPECT_TRUE(file_bytes(png).starts_with("\x89PNG"));
  }
  const auto report = nlohmann::json::parse(file_bytes(folder.path() / "report.json"));
  const auto table = nlohmann::json::parse(file_bytes(folder.path() / "data" / "figure2_second_difference.json"));
  EXPECT_EQ(report["Figure 2"]["figure2_second_difference"], table);
  const std::string csv = file_bytes(folder.path() / "data" / "figure2_second_difference.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(table["rows"].size()) + 1);
  // The vector triangle divided by dh^2 is a second derivative of order 2.
  EXPECT_NEAR(table["rows"].back()["order"].get<double>(), 2, 0.02);
}

TEST(PaperCommand, GrowsTheSameCellsThroughFacesInEveryDimension) {
  const TempFolder folder;
  ASSERT_EQ(run_taut({"paper", "figure1", "--out", folder.path().string()}).exit_code, 0);
  const auto table = nlohmann::json::parse(file_bytes(folder.path() / "data" / "figure1_neighbours.json"));
  ASSERT_EQ(table["rows"].size(), 5U);
  for (const auto& row : table["rows"]) {
    EXPECT_EQ(row["Algorithm I, cells"], row["Algorithm II, one seed, cells"]) << row;
  }
}

TEST(PaperCommand, RefusesAPartThatIsNotThere) {
  const TempFolder folder;
  const ProgramResult result = run_taut({"paper", "figure8", "--out", folder.path().string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("figure8"), std::string::npos);
  EXPECT_NE(result.err.find("appendix1"), std::string::npos) << "says which parts there are: " << result.err;
  EXPECT_EQ(run_taut({"paper", "figure1"}).exit_code, 2) << "no --out";
}

TEST(PaperCommand, RefusesAFolderThatCannotBeWritten) {
  const TempFolder folder;
  const fs::path file = folder.path() / "taken";
  std::ofstream(file) << "a file where a folder should be";
  const ProgramResult result = run_taut({"paper", "figure1", "--out", (file / "report").string()});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("taken"), std::string::npos) << result.err;
  EXPECT_EQ(run_taut({"paper", "figure1", "--out", folder.path().string(), "--data", "/no/such/folder"}).exit_code, 3);
}

}  // namespace
}  // namespace taut::test
