// Random mechanism files: every type of limb and every optional key, for tests against differences.
#pragma once

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "engine/math/random.hpp"

namespace pkm::test {

/// Writes the text of a mechanism with random limbs, margins, box and sweep. Every dimension is a parameter.
class RandomMechanism {
 public:
  /// @param curves  whether columns may end at roots that only intervals isolate, which takes long
  RandomMechanism(Stream& random, bool curves) : random_(random), curves_(curves) {}

  std::string text() {
    constexpr std::array<const char*, 4> kPlatforms[] = {
        {"x", "y"}, {"x", "y", "phi"}, {"x", "y", "z"}, {"x", "y", "z", "phi"}};
    const std::size_t kind = random_.below(4);
    planar_ = kind < 2;
    turns_ = kind % 2 == 1;
    for (const char* const coordinate : kPlatforms[kind])
      if (coordinate) coordinates_.push_back(coordinate);
    const std::string w = length("w", planar_ ? 0.2 : 0.15, 0.7), h = planar_ ? "" : length("h", 0.3, 0.9);
    radius_ = length("R", 0.25, 0.5);
    platform_ = length("r", 0.03, 0.12);
    std::string limbs;
    if (random_.chance(0.15))
      limbs = formulas();
    else if (random_.chance(0.4) && coordinates_.size() >= 3)
      limbs = limb("arm", true);
    else
      for (std::size_t i = 0; i < coordinates_.size(); ++i) limbs += limb("limb" + std::to_string(i + 1), false);
    std::string margins;
    for (std::size_t i = random_.below(3); i > 0; --i) margins += margin(i);

    std::ostringstream out;
    out << "[mechanism]\nname = \"random\"\n[parameters]\n" << parameters_.str() << "[platform]\ncoordinates = { ";
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      out << (i > 0 ? ", " : "") << coordinates_[i]
          << (coordinates_[i] == "phi" ? " = \"about z\"" : " = \"along " + coordinates_[i] + "\"");
    out << " }\n" << (turns_ ? "characteristic_length = \"0.1 m\"\n" : "") << "characteristic_radius = \"0.1 m\"\n";
    out << "[survey]\nsweep = [";
    std::vector<std::string> order = coordinates_;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_.below(i)]);
    std::vector<std::string> swept;
    const std::size_t most = 1 + random_.below(curves_ ? 2 : 3);
    for (const std::string& each : order)
      if (swept.size() < most && (each != "phi" || swept.empty() || random_.chance(0.5))) swept.push_back(each);
    for (std::size_t i = 0; i < swept.size(); ++i) out << (i > 0 ? ", " : "") << '"' << swept[i] << '"';
    out << "]\nbox = { x = [\"-" << w << "\", \"" << w << "\"], y = [\"-" << w << "\", \"" << w << "\"]";
    if (!planar_) out << ", z = [\"" << h << " - 0.4*" << w << "\", \"" << h << " + 0.4*" << w << "\"]";
    if (turns_) out << ", phi = [-0.4, 0.5]";
    out << " }\n" << limbs << margins;
    return out.str();
  }

 private:
  double between(double from, double to) { return from + (to - from) * random_.u01(); }
  static std::string number(double x) {
    std::ostringstream out;
    out.precision(5);
    out << x;
    return out.str();
  }
  const char* pick(std::initializer_list<const char*> words) { return words.begin()[random_.below(words.size())]; }

  /// Adds a parameter. @return  its name
  std::string parameter(const std::string& name, double value, const std::string& unit, double least) {
    parameters_ << name << " = { default = \"" << number(value) << ' ' << unit << "\", min = \"" << number(least) << ' '
                << unit << "\", max = \"10 " << unit << "\" }\n";
    return name;
  }
  std::string length(const std::string& name, double from, double to) {
    return parameter(name, between(from, to), "m", 1e-4);
  }
  std::string place(const std::string& name, double value) { return parameter(name, value, "m", -10); }
  std::string angle(const std::string& name, double from, double to) {
    return parameter(name, between(from, to), "rad", -10);
  }

  /// The same joints by formulas with roots.
  std::string formulas() {
    std::ostringstream out;
    const std::string l = length("l", 0.6, 1.0), top = place("top", between(0.5, 1.0));
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const double at = 2.1 * static_cast<double>(i) + 0.3;
      const std::string u = "(x - " + number(std::cos(at)) + "*R)",
                        v = "(y - " + number(std::sin(at)) + "*R" + (turns_ ? " + r*sin(phi))" : ")");
      const std::string q = "q" + std::to_string(i + 1);
      out << "[[limb]]\nname = \"f" << i << "\"\ndrive = \"formula\"\nunit = \"m\"\njoints = { " << q << " = \"";
      if (planar_)
        out << "sqrt(" << u << "^2 + " << v << "^2)";
      else
        out << "z + sqrt(" << l << "^2 - " << u << "^2 - " << v << "^2)";
      out << "\" }\n[[margin]]\nname = \"most " << q << "\"\nformula = \"" << (planar_ ? l : top + " + " + l) << " - "
          << q << "\"\nunit = \"m\"\n";
    }
    return out.str();
  }

  /// @param copies  as many as the mechanism needs, turned about z
  std::string limb(const std::string& name, bool copies) {
    std::ostringstream out;
    const double at = copies ? 0.2 : 2 * 3.14159 * random_.u01(), c = std::cos(at), s = std::sin(at);
    out << "[[limb]]\nname = \"" << name << "\"\n";
    if (copies) out << "copies = { number = " << coordinates_.size() << ", about = \"z\" }\n";
    const std::string lift = planar_ || random_.chance(0.5) ? "0" : place(name + "_a", between(-0.1, 0.1));
    out << "base = [\"" << number(c) << "*R\", \"" << number(s) << "*R\", \"" << lift << "\"]\nplatform = [\""
        << number(c) << "*r\", \"" << number(s) << "*r\", 0]\n";
    const std::size_t drive = random_.below(planar_ ? 4 : 3);
    const bool across = planar_ && random_.chance(0.7), branch = random_.chance(0.5);
    const std::string sign = branch ? "+" : "-";
    bool has_rod = true;
    double q = 0;  // what the joint is about
    double wide = 0.4;
    std::string unit = "m";
    if (drive == 0) {
      out << "drive = \"telescope\"\n";
      q = planar_ ? 0.35 : 0.65;
      wide = 0.25;
    } else if (drive == 1 && !random_.chance(0.25)) {
      const bool upright = !planar_ && random_.chance(0.7);
      out << "drive = \"slider\"\nrod = \"" << length(name + "_l", 0.35, 0.8) << "\"\nbranch = \"" << sign << "\"\n"
          << (upright ? "direction = [0, 0, 1]\n"
                      : "direction = [" + number(-s) + ", " + number(c) + ", " + (planar_ ? "0" : "0.3") + "]\n");
      q = upright ? (branch ? 1.0 : 0.1) : (branch ? 0.4 : -0.4);
    } else if (drive <= 1) {
      has_rod = false;
      out << "drive = \"slider\"\ndirection = [" << number(-c) << ", " << number(-s) << ", 0]\n";
      q = 0.35;
    } else if (drive == 2) {
      out << "drive = \"crank\"\ncrank = \"" << length(name + "_a_l", 0.2, 0.4) << "\"\nrod = \""
          << length(name + "_b_l", 0.4, 0.8) << "\"\nbranch = \"" << sign << "\"\n"
          << (planar_ ? "axis = [0, 0, 1]\nzero = [1, 0, 0]\n"
                      : "axis = [" + number(-s) + ", " + number(c) + ", 0]\nzero = [" + number(c) + ", " + number(s) +
                            ", 0]\n");
      if (across) out << "across = [0, 0, 1]\n";
      unit = "rad";
      q = planar_ ? at + 3 : 0;
      wide = 1.5;
    } else {
      has_rod = false;
      out << "drive = \"slider\"\nalong = [0, 0, 1]\nlinks = [\"" << length(name + "_l_1", 0.2, 0.5) << "\", \""
          << length(name + "_l_2", 0.2, 0.5) << "\"]\nbranch = \"" << sign << "\"\n";
      q = 0;
    }
    if (random_.chance(drive == 2 ? 0.9 : 0.6)) {
      const std::string low = parameter(name + "_low", q - wide * between(0.3, 1), unit, -20),
                        high = parameter(name + "_high", q + wide * between(0.3, 1), unit, -20);
      out << "range = [\"" << low << "\", \"" << high << "\"]\n";
    }
    for (const char* const end : {"base", "platform"}) {
      if (!has_rod || (drive > 0 && !curves_) || !random_.chance(curves_ ? 0.5 : 0.3)) continue;
      out << "joint_" << end << " = { axis = ["
          << (planar_ ? number(-c) + ", " + number(-s) + ", 0" : std::string("0, 0, ") + pick({"1", "-1"}))
          << "], in = \"" << pick({"base", "platform"}) << "\", ";
      const bool max = random_.chance(0.7);
      out << (max ? "max" : "min") << " = \"" << angle(name + "_" + end, max ? 0.5 : 0.05, max ? 1.4 : 0.4) << "\" }\n";
    }
    return out.str();
  }

  /// Some contain coordinates formally only, or at this design only.
  std::string margin(std::size_t i) {
    const std::string a = place("m" + std::to_string(i), between(-0.1, 0.15));
    const std::string u = coordinates_[random_.below(2)], v = coordinates_[random_.below(coordinates_.size())];
    std::string formula;
    switch (curves_ ? 7 + random_.below(2) : random_.below(7)) {
      case 0:
        formula = "(" + u + " + " + v + ") - " + v + " + " + a;
        break;
      case 1:
        formula = a + " - " + u + " + 0*" + v;
        break;
      case 7:
        formula = a + " + 0.3*" + u + " + sin(" + v + ") - sin(" + v + ")";
        break;
      case 2:
        formula = "sqrt((" + u + " + 2)^2 + (" + v + " - " + v + ")^2) - 2 + " + a;
        break;
      case 3: {
        const std::string tilt = parameter("tilt" + std::to_string(i), 0, "rad", -3);
        formula = u + "*cos(" + tilt + ") + " + v + "*sin(" + tilt + ") + " + a;
        break;
      }
      case 4:
        formula = "min(" + u + " + " + a + " + 0*" + v + ", 0.3 - " + v + ")";
        break;
      case 5:
        formula = "max(" + u + " + " + a + ", " + v + " - 0.05)";
        break;
      case 8:
        formula = "exp(" + u + ")*exp(" + v + ")/exp(" + v + ") - 1 + " + a;
        break;
      default:
        formula = "0.04 + " + a + "^2 - (" + u + " - 0.05)^2 - (" + v + " - " + a + ")^2";
        break;
    }
    return "[[margin]]\nname = \"margin" + std::to_string(i) + "\"\nformula = \"" + formula + "\"\nunit = \"m\"\n";
  }

  Stream& random_;
  bool curves_;
  bool planar_ = false, turns_ = false;
  std::vector<std::string> coordinates_;
  std::string radius_, platform_;
  std::ostringstream parameters_;
};

}  // namespace pkm::test
