// What is said of bad input, word for word: one line with the place, what is wrong and what is expected.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include <maximin/models/files/cassandra.hpp>
#include <maximin/models/files/csv.hpp>
#include <maximin/models/files/drn.hpp>
#include <maximin/models/files/gymnasium_json.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/files/prism_explicit.hpp>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

/// A text, and what is said of it.
struct BadInput {
  std::string text;
  std::string message;
};

template <class Read>
void expect_messages(const std::vector<BadInput>& cases, Read read) {
  for (const BadInput& bad : cases) {
    const std::string said = testing::error_of([&] { read(bad.text); });
    EXPECT_EQ(said, bad.message) << bad.text;
    EXPECT_EQ(said.find('\n'), std::string::npos) << bad.text;
    EXPECT_NE(said.find("expected"), std::string::npos) << bad.text;
  }
}

/// Own JSON with one member replaced or added.
std::string json_with(const std::string& name, const std::string& value) {
  std::vector<std::pair<std::string, std::string>> members = {{"format", "\"maximin-mdp\""},
                                                              {"version", "1"},
                                                              {"states", "2"},
                                                              {"actions", "1"},
                                                              {"discount", "0.5"},
                                                              {"rewards", "[[0],[0]]"},
                                                              {"transitions", "[[0,0,1,1],[1,0,1,1]]"}};
  bool found = false;
  for (auto& member : members) {
    if (member.first != name) continue;
    member.second = value;
    found = true;
  }
  if (!found) members.emplace_back(name, value);
  std::string text;
  for (const auto& member : members) {
    if (member.second.empty()) continue;  // left out
    text += (text.empty() ? "{\"" : ",\n\"") + member.first + "\":" + member.second;
  }
  return text + "}";
}

TEST(BadInput, MaximinJson) {
  expect_messages(
      {
          {"",
           "m.json:1: not JSON: syntax error while parsing value - unexpected end of input; expected '[', '{', or a "
           "literal"},
          {"{",
           "m.json:1: not JSON: syntax error while parsing object key - unexpected end of input; expected string "
           "literal"},
          {"[]", "m.json: $: not an object, expected a model"},
          {R"({"format":"maximin-mdp"})", "m.json: $: 'version' is missing, expected 1"},
          {"{\"format\":\"maximin-mdp\",\"version\":1,\n\"states\":1e999}",
           "m.json:2: not JSON: number overflow parsing '1e999', expected a number that a double can hold"},
          {"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[", "m.json: nested more than 32 deep, expected a model"},
          {json_with("format", R"("other")"), R"(m.json: $.format: format 'other', expected "maximin-mdp")"},
          {json_with("format", "1"), R"(m.json: $.format: not a string, expected "maximin-mdp")"},
          {json_with("version", "2"), "m.json: $.version: version 2, expected 1"},
          {json_with("states", "0"), "m.json: $.states: 0 states, expected at least 1"},
          {json_with("states", "-1"), "m.json: $.states: number of states: not a non-negative integer, expected one"},
          {json_with("states", "1.5"), "m.json: $.states: number of states: not a non-negative integer, expected one"},
          {json_with("states", R"("2")"),
           "m.json: $.states: number of states: not a non-negative integer, expected one"},
          {json_with("states", "1000000000000000000"),
           "m.json: $.states: 1000000000000000000 states and 1 actions are too many, expected at most 5000000 (state, "
           "action) pairs"},
          {json_with("states", "100000000000000000000000"),
           "m.json: $.states: 18446744073709551615 states and 1 actions are too many, expected at most 5000000 (state, "
           "action) pairs"},
          {json_with("states", ""), "m.json: $: 'states' is missing, expected the number of states"},
          {json_with("actions", "3"),
           "m.json: $.transitions: 2 transitions for 2 states and 3 actions, expected at least one for each of the 6 "
           "pairs"},
          {json_with("actions", "0"), "m.json: $.actions: 0 actions, expected at least 1"},
          {json_with("discount", "1"),
           "m.json: $.discount: discount 1: outside the range, expected 0 <= discount < 1; choose one with --discount, "
           "e.g. --discount 0.95"},
          {json_with("discount", "-0.5"),
           "m.json: $.discount: discount -0.5: outside the range, expected 0 <= discount < 1; choose one with "
           "--discount, e.g. --discount 0.95"},
          {json_with("discount", ""),
           "m.json: $: 'discount' is missing, expected a number from 0 up to but not including 1"},
          {json_with("discount", R"("nan")"),
           "m.json: $.discount: discount 'nan': not a number, expected an integer, a decimal or a fraction such as "
           "1/3"},
          {json_with("discount", "[]"),
           R"(m.json: $.discount: discount: not a number, expected one such as 0.5 or "1/3")"},
          {json_with("rewards", "[[0]]"), "m.json: $.rewards: length 1, expected 2: one row per state"},
          {json_with("rewards", "[[0],[0,1]]"), "m.json: $.rewards[1]: length 2, expected 1: one reward per action"},
          {json_with("rewards", R"([[0],["x"]])"),
           "m.json: $.rewards[1][0]: reward 'x': not a number, expected an integer, a decimal or a fraction such as "
           "1/3"},
          {json_with("rewards", "[[0],[null]]"),
           R"(m.json: $.rewards[1][0]: reward: not a number, expected one such as 0.5 or "1/3")"},
          {json_with("rewards", R"([[0],["1/0"]])"),
           "m.json: $.rewards[1][0]: reward '1/0': denominator 0, expected a fraction such as 1/3"},
          {json_with("rewards", R"([[0],["inf"]])"),
           "m.json: $.rewards[1][0]: reward 'inf': not a number, expected an integer, a decimal or a fraction such as "
           "1/3"},
          {json_with("rewards", "[0,0]"), "m.json: $.rewards[0]: not an array, expected one reward per action"},
          {json_with("rewards", ""),
           "m.json: $: 'rewards' is missing, expected one row per state, one number per action"},
          {json_with("reward", "[[0],[0]]"), "m.json: $.reward: unknown name, expected 'rewards'?"},
          {json_with("transitions", "[]"),
           "m.json: $.transitions: 0 transitions for 2 states and 1 actions, expected at least one for each of the 2 "
           "pairs"},
          {json_with("transitions", "[[0,0,1,1],[1,0,1]]"),
           "m.json: $.transitions[1]: length 3, expected 4: [state, action, next state, probability]"},
          {json_with("transitions", "[[0,0,1,1],[1,0,2,1]]"),
           "m.json: $.transitions[1][2]: state '2': no such state, expected an integer from 0 to 1"},
          {json_with("transitions", "[[0,0,1,1],[1,1,1,1]]"),
           "m.json: $.transitions[1][1]: action '1': no such action, expected an integer from 0 to 0"},
          {json_with("transitions", "[[0,0,1,1],[1,0,-1,1]]"),
           "m.json: $.transitions[1][2]: state '-1': no such state, expected an integer from 0 to 1"},
          {json_with("transitions", "[[0,0,1,1],[1,0,1.5,1]]"),
           "m.json: $.transitions[1][2]: state '1.5': no such state, expected an integer from 0 to 1"},
          {json_with("transitions", "[[0,0,1,1],[1,0,1,-0.5],[1,0,0,1.5]]"),
           "m.json: $.transitions[1]: probability -0.5: outside the range, expected 0 to 1"},
          {json_with("transitions", "[[0,0,1,1],[1,0,1,0.9]]"),
           R"(m.json: $.transitions[1]: state 1, action 0: probabilities sum to 0.9, expected 1; thirds can be written as fractions, "1/3")"},
          {json_with("transitions", "[[0,0,1,1],[1,0,1,0.333],[1,0,0,0.667],[1,0,1,0]]"),
           "m.json: $.transitions[3]: state 1, action 0, target 1: given twice, expected each (state, action, target) "
           "once"},
          {json_with("transitions", "[[0,0,1,1],[0,0,0,0]]"),
           "m.json: $.transitions: state 1, action 0: no transitions, expected probabilities that sum to 1"},
          {json_with("transitions", "[[0,0,1,0.999999998],[1,0,1,1]]"),
           R"(m.json: $.transitions[0]: state 0, action 0: probabilities sum to 0.999999998, expected 1; thirds can be written as fractions, "1/3")"},
          {json_with("transitions", "{}"),
           "m.json: $.transitions: not an array, expected a list of [state, action, next state, probability]"},
          {json_with("transitions", ""),
           "m.json: $: 'transitions' is missing, expected a list of [state, action, next state, probability]"},
          {json_with("name", "3"), "m.json: $.name: not a string, expected a name"},
          {json_with("notes", R"("x")"), "m.json: $.notes: not an array, expected a list of strings"},
          {json_with("notes", "[1]"), "m.json: $.notes[0]: not a string, expected a note"},
          {json_with("state_names", R"(["a"])"), "m.json: $.state_names: length 1, expected 2: one name each"},
          {json_with("state_names", R"(["a","a"])"),
           "m.json: $.state_names[1]: 'a' given twice, expected distinct names"},
          {json_with("state_names", R"(["a",""])"),
           "m.json: $.state_names[1]: '': empty or with control characters, expected a name"},
          {json_with("state_names", R"(["a","b\u0007"])"),
           R"(m.json: $.state_names[1]: 'b\x07': empty or with control characters, expected a name)"},
          {json_with("state_names", R"(["a","b\u202e"])"),
           R"(m.json: $.state_names[1]: 'b\xe2\x80\xae': empty or with control characters, expected a name)"},
          {json_with("name", R"("\ud800")"),
           "m.json:8: not JSON: syntax error while parsing value - invalid string: surrogate U+D800..U+DBFF must be "
           "followed by U+DC00..U+DFFF; last read: '\"\\ud800\"', expected JSON as in RFC 8259"},
          {json_with("action_names", R"(["a","b"])"), "m.json: $.action_names: length 2, expected 1: one name each"},
          {json_with("start", "[1]"), "m.json: $.start: length 1, expected 2: a state, or one probability per state"},
          {json_with("start", "[0.5,0.4]"),
           R"(m.json: $.start: probabilities sum to 0.9, expected 1; thirds can be written as fractions, "1/3")"},
          {json_with("start", "[1.5,-0.5]"), "m.json: $.start[1]: probability '-0.5': negative, expected 0 to 1"},
          {json_with("start", "2"), "m.json: $.start: state '2': no such state, expected an integer from 0 to 1"},
          {json_with("start", R"("a")"), "m.json: $.start: no state is named 'a', expected one of state_names"},
          {json_with("eps", "-1"), "m.json: $.eps: eps '-1': negative, expected eps >= 0"},
          {json_with("norm", R"("l1")"), "m.json: $.norm: given without 'points', expected both or neither"},
          {json_with("points", "[[0],[1]],\n\"norm\":\"l3\""),
           R"(m.json: $.norm: norm 'l3', expected "l1", "l2" or "linf")"},
          {json_with("points", "[[0],[1,2]]"),
           "m.json: $.points[1]: length 2, expected 1: one coordinate per dimension"},
          {json_with("points", "[[],[]]"), "m.json: $.points[0]: no coordinates, expected at least one"},
          {json_with("points", "[[0]]"), "m.json: $.points: length 1, expected 2: one point per state"},
          {json_with("points", "[[0],[1]],\n\"metric\":\"hops\""),
           "m.json: $.metric: given as well as 'points', expected only one of points, distances, neighbourhoods, "
           "metric"},
          {json_with("metric", R"("taxi")"), R"(m.json: $.metric: metric 'taxi', expected "hops" or "discrete")"},
          {json_with("distances", "[[0,1],[2,0]]"),
           "m.json: $.distances[0][1]: differs from distances[1][0], expected a symmetric matrix"},
          {json_with("distances", "[[0,1],[1,1]]"),
           "m.json: $.distances[1][1]: not 0, expected a state to be at distance 0 from itself"},
          {json_with("distances", "[[0,-1],[-1,0]]"),
           "m.json: $.distances[0][1]: negative or not a number, expected a distance >= 0"},
          {json_with("distances", "[[0,1]]"), "m.json: $.distances: length 1, expected 2: one row per state"},
          {json_with("neighbourhoods", "[[0],[]]"),
           "m.json: $.neighbourhoods[1]: empty ball, expected at least the state itself"},
          {json_with("neighbourhoods", "[[0,1],[1]]"),
           "m.json: $.neighbourhoods[0]: lists state 1, which does not list it back, expected symmetric balls"},
          {json_with("neighbourhoods", "[[1],[0]]"),
           "m.json: $.neighbourhoods[0]: lacks state 0 itself, expected a ball to contain its centre"},
          {json_with("neighbourhoods", "[[0,2],[1]]"),
           "m.json: $.neighbourhoods[0][1]: state '2': no such state, expected an integer from 0 to 1"},
          {json_with("neighbourhoods", "[[0,0],[1]]"),
           "m.json: $.neighbourhoods[0]: state 0 listed twice, expected each state once"},
          {json_with("neighbourhoods", "[[0],[1]],\n\"eps\":2"),
           "m.json: $.eps: eps '2' with 'neighbourhoods', expected 1 or none: the lists are the balls"},
          {json_with("states", "2,\n\"states\":2"), "m.json: $.states: given twice, expected each name once"},
      },
      [](const std::string& text) { read_maximin_json<double>(text, "m.json"); });
}

TEST(BadInput, GymnasiumJson) {
  expect_messages(
      {
          {R"({"nS":1,"nA":1})",
           "g.json: $: 'P' is missing, expected P[state][action], lists of [probability, next state, reward, "
           "terminated]"},
          {R"({"nS":1000000000000000000,"nA":1,"P":[]})",
           "g.json: $.nS: 1000000000000000000 states and 1 actions are too many, expected at most 5000000 (state, "
           "action) pairs"},
          {R"({"nS":1000000,"nA":1,"P":[]})", "g.json: $.P: length 0, expected 1000000: one member per state"},
          {R"({"nS":1,"nA":1,"P":[]})", "g.json: $.P: length 0, expected 1: one member per state"},
          {R"({"nS":1,"nA":1,"P":[[]]})", "g.json: $.P[0]: length 0, expected 1: one member per action"},
          {R"({"nS":1,"nA":1,"P":[[[]]]})",
           "g.json: $.P: state 0, action 0: no transitions, expected probabilities that sum to 1"},
          {R"({"nS":1,"nA":1,"P":[[[[1,0,0]]]]})",
           "g.json: $.P[0][0][0]: length 3, expected 4: [probability, next state, reward, terminated]"},
          {R"({"nS":1,"nA":1,"P":[[[[1,0,0,1]]]]})",
           "g.json: $.P[0][0][0][3]: neither true nor false, expected one: whether the episode ends"},
          {R"({"nS":1,"nA":1,"P":[[[[1,1,0,false]]]]})",
           "g.json: $.P[0][0][0][1]: state '1': no such state, expected an integer from 0 to 0"},
          {R"({"nS":1,"nA":1,"P":[[[[0.5,0,0,false]]]]})",
           R"(g.json: $.P[0][0]: state 0, action 0: probabilities sum to 0.5, expected 1; thirds can be written as fractions, "1/3")"},
          {R"({"nS":1,"nA":1,"P":[[[[-1,0,0,false],[2,0,0,false]]]]})",
           "g.json: $.P[0][0][0]: probability -1: negative, expected 0 to 1"},
          {R"({"nS":1,"nA":1,"P":[[[[1,0,"x",false]]]]})",
           "g.json: $.P[0][0][0][2]: reward 'x': not a number, expected an integer, a decimal or a fraction such as "
           "1/3"},
          {R"({"nS":1,"nA":1,"P":{"1":[[[1,0,0,false]]]}})", R"(g.json: $.P.1: out of order, expected the name "0")"},
          {R"({"nS":1,"nA":1,"P":[[[[1,0,0,false]]]],"initial_distribution":[0.5]})",
           R"(g.json: $.initial_distribution: probabilities sum to 0.5, expected 1; thirds can be written as fractions, "1/3")"},
          {R"({"nS":1,"nA":1,"P":[[[[1,0,0,false]]]],"nN":1})", "g.json: $.nN: unknown name, expected 'nS'?"},
      },
      [](const std::string& text) { read_gymnasium_json<double>(text, "g.json"); });
}

TEST(BadInput, Csv) {
  expect_messages(
      {
          {"", "m.csv: no transitions, expected lines of idstatefrom,idaction,idstateto,probability,reward"},
          {"idstatefrom,idaction,idstateto,probability,reward\n",
           "m.csv: no transitions, expected lines of idstatefrom,idaction,idstateto,probability,reward"},
          {"idstatefrom,idaction,idstateto,prob,reward\n",
           "m.csv:1: header without 'probability', expected idstatefrom,idaction,idstateto,probability,reward"},
          {"0,0,0,1\n", "m.csv:1: 4 fields, expected 5: idstatefrom,idaction,idstateto,probability,reward"},
          {"0,0,0,1,0\n0,0\n", "m.csv:2: 2 fields, expected 5: idstatefrom,idaction,idstateto,probability,reward"},
          {"0,0,0,1,x\n",
           "m.csv:1: reward 'x': not a number, expected an integer, a decimal or a fraction such as 1/3"},
          {"0,0,0,nan,0\n",
           "m.csv:1: probability 'nan': not a number, expected an integer, a decimal or a fraction such as 1/3"},
          {"0,0,0,-1,0\n", "m.csv:1: probability -1: outside the range, expected 0 to 1"},
          {"0,0,0,0.5,0\n", "m.csv:1: state 0, action 0: probabilities sum to 0.5, expected 1"},
          {"0,0,0,0.5,0\n0,0,0,0.5,0\n",
           "m.csv:2: state 0, action 0, target 0: given twice, expected each (state, action, target) once"},
          {"0,0,1,1,0\n", "m.csv:1: state 1 in a file of 1 transitions, expected every state to have one"},
          {"0,0,1000000000000000000,1,0\n", "m.csv:1: state 1000000000000000000: too large, expected at most 5000000"},
          {"0,1,0,1,0\n", "m.csv:1: state 0 has action 1 but not action 0, expected actions from 0 without a gap"},
          {"0,0,0,1,0\n0,2,0,1,0\n",
           "m.csv:2: state 0 has action 2 but not action 1, expected actions from 0 without a gap"},
          {"1,0,1,1,0\n1,1,1,1,0\n", "m.csv: state 0: no transitions, expected at least one action"},
          {"-1,0,0,1,0\n", "m.csv:1: idstatefrom '-1': expected a non-negative integer"},
          {"0.5,0,0,1,0\n", "m.csv:1: idstatefrom '0.5': expected a non-negative integer"},
          {"0,0,0,1,0\n\x01\n", "m.csv:2: byte 0x01 is not text, expected UTF-8"},
      },
      [](const std::string& text) { read_csv<double>(text, "m.csv"); });
}

TEST(BadInput, Drn) {
  expect_messages(
      {
          {"", "m.drn: the file ends before the model, expected '@model'"},
          {"@type: CTMC\n", "m.drn:1: type 'CTMC': expected MDP, POMDP or DTMC"},
          {"@type: MDP\n", "m.drn:1: the file ends before the model, expected '@model'"},
          {"@model\n", "m.drn:1: no '@type:' in the header, expected '@type: MDP'"},
          {"@type: MDP\n@model\n", "m.drn:2: no '@nr_states' in the header, expected the number of states"},
          {"@type: MDP\n@nr_states\n", "m.drn:2: the file ends in its header, expected '@model'"},
          {"@type: MDP\n@nr_states\n1000000000000000000\n@model\n",
           "m.drn:3: 1000000000000000000 states in a file of 5 lines, expected at least 1 and a line for each"},
          {"@type: MDP\n@nr_states\n0\n@model\n",
           "m.drn:3: 0 states in a file of 5 lines, expected at least 1 and a line for each"},
          {"@type: MDP\n@nr_states\nmany\n@model\n",
           "m.drn:3: number of states 'many': expected a non-negative integer"},
          {"@type: MDP\n@value_type: parametric\n",
           "m.drn:2: value_type parametric: expected numbers without parameters"},
          {"@type: MDP\n@parameters\np q\n", "m.drn:3: parameters 'p q': expected none"},
          {"@typo: MDP\n",
           "m.drn:1: '@typo:': unknown, expected one of @type:, @value_type:, @parameters, @placeholders, "
           "@reward_models, @nr_states, @nr_choices, @model"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\n",
           "m.drn:6: the file ends after 0 states, expected 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\naction a\n",
           "m.drn:7: an action before the first state, expected 'state 0'"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\n0 : 1\n",
           "m.drn:7: a transition before the first state, expected 'state 0'"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 1\n",
           "m.drn:7: state '1': no such state, expected an integer from 0 to 0"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate x\n",
           "m.drn:7: state 'x': no such state, expected an integer from 0 to 0"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n",
           "m.drn: state 0: no choices, expected at least one"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n",
           "m.drn: state 0, action 0: no transitions, expected probabilities that sum to 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : 0.5\n",
           "m.drn:9: state 0, action 0: probabilities sum to 0.5, expected 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : 0.5\n\t\t0 : 0.5\n",
           "m.drn:10: state 0, action 0, target 0: given twice, expected each (state, action, target) once"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t1 : 1\n",
           "m.drn:9: state '1': no such state, expected an integer from 0 to 0"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : p\n",
           "m.drn:9: probability 'p': not a number, expected an integer, a decimal or a fraction such as 1/3"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : 1/0\n",
           "m.drn:9: probability '1/0': denominator 0, expected a fraction such as 1/3"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : $x\n",
           "m.drn:9: '$x' is not defined, expected one of the @placeholders"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : -1\n",
           "m.drn:9: probability -1: outside the range, expected 0 to 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 = 1\n",
           "m.drn:9: '0 = 1': expected 'state', 'action' or 'target : probability'"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0 [1\n",
           "m.drn:7: '[1' is never closed, expected ']'"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0 [1, 2]\n",
           "m.drn:7: 2 rewards, expected 1, one per reward model"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0 [1,]\n",
           "m.drn:7: a comma without a reward after it, expected [r1, r2]"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0 [x]\n",
           "m.drn:7: reward 'x': not a number, expected an integer, a decimal or a fraction such as 1/3"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a [1] b\n\t\t0 : 1\n",
           "m.drn:8: 'b' after the action, expected nothing more"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : [0.5]\n",
           "m.drn:9: probability '[0.5]': expected a number or an interval such as [0.4,0.6]"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : 1\nstate 0\n",
           "m.drn:10: state 0: out of order, expected 1"},
          {"@type: MDP\n@nr_states\n2\n@nr_choices\n3\n@model\nstate 0\n\t0 : 1\nstate 1\n\t1 : 1\n",
           "m.drn:5: 3 choices announced but 2 found, expected the same number"},
      },
      [](const std::string& text) { read_drn<double>(text, "m.drn"); });
}

TEST(BadInput, DrnIntervals) {
  ReadOptions nominal;
  nominal.intervals = IntervalRows::nominal;
  expect_messages(
      {
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : [0.1, 0.5]\n",
           "m.drn:8: intervals sum to [0.1,0.5], expected 1 to lie between"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : [0.5, 0.1]\n",
           "m.drn:9: interval [0.5,0.1]: expected 0 <= lo <= hi <= 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : [-1, 1]\n",
           "m.drn:9: interval [-1,1]: expected 0 <= lo <= hi <= 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : [0.5, 2]\n",
           "m.drn:9: interval [0.5,2]: expected 0 <= lo <= hi <= 1"},
          {"@type: MDP\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0\n\taction a\n\t\t0 : [0.5, nan]\n",
           "m.drn:9: probability 'nan': not a number, expected an integer, a decimal or a fraction such as 1/3"},
      },
      [&](const std::string& text) { read_drn<double>(text, "m.drn", nominal); });
}

TEST(BadInput, PrismExplicit) {
  expect_messages(
      {
          {"", "m.tra: no sizes, expected a line 'states choices transitions'"},
          {"# only a comment\n", "m.tra:1: no sizes, expected a line 'states choices transitions'"},
          {"1\n", "m.tra:1: 1 numbers, expected 'states choices transitions'"},
          {"1 1 1 1 1\n", "m.tra:1: 5 numbers, expected 'states choices transitions'"},
          {"a b c\n", "m.tra:1: number of states 'a': expected a non-negative integer"},
          {"1000000000000000000 1 1\n",
           "m.tra:1: 1000000000000000000 states in a file of 2 lines, expected at least 1 and a line for each"},
          {"0 0 0\n", "m.tra:1: 0 states in a file of 2 lines, expected at least 1 and a line for each"},
          {"2 1 1\n0 0 0 1\n", "m.tra:2: the file ends after 1 states, expected 2"},
          {"1 2 1\n0 0 0 1\n", "m.tra:1: 2 choices announced but 1 found, expected the same number"},
          {"1 1 2\n0 0 0 1\n", "m.tra:1: 2 transitions announced but 1 found, expected the same number"},
          {"1 1 1\n1 0 0 1\n", "m.tra:2: state '1': no such state, expected an integer from 0 to 0"},
          {"1 1 1\n0 1 0 1\n", "m.tra:2: choice '1': no such choice, expected an integer from 0 to 0"},
          {"1 1 1\n0 0 1 1\n", "m.tra:2: state '1': no such state, expected an integer from 0 to 0"},
          {"1 1 1\n0 0 0 x\n",
           "m.tra:2: probability 'x': not a number, expected an integer, a decimal or a fraction such as 1/3"},
          {"1 1 1\n0 0 0\n", "m.tra:2: 3 words, expected 'state choice target probability [action]'"},
          {"1 1 1\n0 0 0 1 a b\n", "m.tra:2: 6 words, expected 'state choice target probability [action]'"},
          {"1 1 1\n0 0 0 0.5\n", "m.tra:2: state 0, action 0: probabilities sum to 0.5, expected 1"},
          {"1 1 2\n0 0 0 0.5\n0 0 0 0.5\n",
           "m.tra:3: state 0, action 0, target 0: given twice, expected each (state, action, target) once"},
          {"1 1 1\n0 0 0 -1\n", "m.tra:2: probability -1: outside the range, expected 0 to 1"},
          {"1 1 2\n0 0 0 0.5 a\n0 0 0 0.5 b\n",
           "m.tra:3: action 'b' in a choice of action 'a', expected one action name per choice"},
          {"2 2 2\n1 0 0 1\n0 0 0 1\n", "m.tra:2: state 1 after none, expected states in order without a gap"},
          {"1 2 3\n0 0 0 1\n0 1 0 1\n0 0 0 1\n", "m.tra:4: choice 0 after choice 1, expected choices in order"},
          {"1 1 1\n0 1:0 a b\n", "m.tra:2: more than one word after the probabilities, expected one action name"},
          {"mdp\n", "m.tra:1: the file ends after 0 states, expected 1"},
          {"mdp\n5 0 0 1\n", "m.tra:2: state 5: states must come in order, expected at most 1"},
          {"1 1 1\n0 0 0 [0,1]\n",
           "m.tra:2: probabilities are intervals, expected numbers; --intervals nominal takes from every row the "
           "member lo + t (hi - lo) that sums to 1"},
      },
      [](const std::string& text) { read_prism_explicit<double>(text, "m.tra"); });
}

TEST(BadInput, Cassandra) {
  expect_messages(
      {
          {"", "m.pomdp:1: no 'states:' before this, expected their number or names"},
          {"discount: 0.5\nstates: 2\nT: 0", "m.pomdp:3: no 'actions:' before this, expected their number or names"},
          {"discount: 0.5\nactions: 2\n", "m.pomdp:3: no 'states:' before this, expected their number or names"},
          {"discount 0.5", "m.pomdp:1: '0.5': unexpected, expected ':'"},
          {"discount: x", "m.pomdp:1: 'x': unexpected, expected a number from 0 up to but not including 1"},
          {"discount: 1.5\nvalues: reward\nstates: 1\nactions: 1\nT: 0 identity\n",
           "m.pomdp:1: discount 1.5: outside the range, expected 0 <= discount < 1; choose one with --discount, e.g. "
           "--discount 0.95"},
          {"discount: 0.5 discount: 0.5", "m.pomdp:1: discount given twice, expected it once"},
          {"values: money", "m.pomdp:1: 'money': unexpected, expected reward or cost"},
          {"states: 0", "m.pomdp:1: 0 states, expected at least 1"},
          {"states: a a", "m.pomdp:1: state 'a' given twice, expected distinct names"},
          {"states: 2 states: 2", "m.pomdp:1: states given twice, expected them once"},
          {"states:\nactions: 2", "m.pomdp:2: 'actions': unexpected, expected a number of states or their names"},
          {"stats: 2",
           "m.pomdp:1: 'stats': unexpected, expected discount, values, states, actions, observations, start, T, O or "
           "R"},
          {"states: 1000000000000000000\nactions: 1\nT: 0 identity\n",
           "m.pomdp:1: 1000000000000000000 states and 1 actions are too many, expected at most 5000000 (state, action) "
           "pairs"},
          {"states: 3000\nactions: 3000\n",
           "m.pomdp:1: 3000 states and 3000 actions are too many, expected at most 5000000 (state, action) pairs"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 1 identity",
           "m.pomdp:5: '1': no such action, expected 0 to 0"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: a identity",
           "m.pomdp:5: 'a': no such action, expected 0 to 0"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 2 : 0 1",
           "m.pomdp:5: '2': no such state, expected 0 to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 0 : 0 x",
           "m.pomdp:5: 'x': unexpected, expected a probability"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 0 : 0 -1",
           "m.pomdp:5: negative probability, expected 0 to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 0 : 0 1.5",
           "m.pomdp:5: probability 1.5: outside the range, expected 0 to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 0 0.5",
           "m.pomdp:5: the file ends, expected a probability"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0\n1 0\n",
           "m.pomdp:7: the file ends, expected a probability"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT 0 identity",
           "m.pomdp:5: '0': unexpected, expected ':'"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 0 0.5 0.4\nT: 0 : 1 uniform",
           "m.pomdp:5: state 0, action 0: probabilities sum to 0.9, expected 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 : 0 : 0 1",
           "m.pomdp: state 1, action 0: no transitions, expected probabilities that sum to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\n",
           "m.pomdp: state 0, action 0: no transitions, expected probabilities that sum to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nO: 0 uniform",
           "m.pomdp:6: O without 'observations:', expected them in the preamble"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nR: 0 : 0 : 0 x",
           "m.pomdp:6: 'x': unexpected, expected a reward"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nR: 0 : 0 : 0 : 1 3",
           "m.pomdp:6: '1': unexpected, expected '*': an MDP has no observations"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nR: 0 : 0 : 0 - 1 2",
           "m.pomdp:6: '2': unexpected, expected T, O or R"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nS: 0",
           "m.pomdp:6: 'S': unexpected, expected T, O or R"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nstates: 2",
           "m.pomdp:6: 'states': unexpected, expected T, O or R"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nT: 0 identity\nT: 0 @",
           "m.pomdp:6: '@': not part of the format, expected names, numbers, '*', ':' or a '#' comment"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nstart: 0.5 0.4\nT: 0 identity\n",
           "m.pomdp:5: start: probabilities sum to 0.9, expected 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nstart: 1 0 0\nT: 0 identity\n",
           "m.pomdp:5: start: 3 entries, expected one probability for each of 2 states, one state, or uniform"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nstart: 2\nT: 0 identity\n",
           "m.pomdp:5: '2': no such state, expected 0 to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nstart exclude: 0 1\nT: 0 identity\n",
           "m.pomdp:5: start: no state left, expected at least one"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nstart:\nT: 0 identity\n",
           "m.pomdp:6: 'T': unexpected, expected probabilities, states or 'uniform'"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nstart: 0\nstart: 1\nT: 0 identity\n",
           "m.pomdp:6: start given twice, expected it once"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nobservations: 2\nT: 0 identity\nR: 0\n1 2 3 4",
           "m.pomdp:8: '1': unexpected, expected ':' and a state"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nobservations: 2\nT: 0 identity\nR: 0 : 0 : 0 : 1 5",
           "m.pomdp:7: this reward needs O for action 0 and state 0, whose probabilities sum to 0, expected 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\nobservations: 2\nT: 0 identity\nR: 0 : 0 : 0 : 2 5",
           "m.pomdp:7: '2': no such observation, expected 0 to 1"},
          {"discount: 0.5\nvalues: reward\nstates: 2\nactions: 1\n\xffT: 0 identity\n",
           "m.pomdp:5: byte 0xff is not text, expected UTF-8"},
      },
      [](const std::string& text) { read_cassandra<double>(text, "m.pomdp"); });
}

}  // namespace
}  // namespace maximin
