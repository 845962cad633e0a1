// A page in headless Chromium, driven as a user drives it: real mouse, touch and key events, and what the page then
// shows. Talks the DevTools protocol over two pipes, so that nothing but the browser itself is needed.
//   Source: https://chromedevtools.github.io/devtools-protocol/
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace plumb {

struct Screen {
    int width = 1280, height = 900;  // CSS pixels
    bool dark = false;
    bool touch = false;
};

class Browser {
public:
    // Chromium's name as the shell finds it; empty where there is none.
    static std::string program();

    // Starts it; `profile` is a folder of its own. Throws std::runtime_error where it does not answer.
    explicit Browser(const std::filesystem::path& profile);
    ~Browser();
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    // Opens the file in a new tab and waits until the page's script came to its end, or said that it failed.
    void open(const std::filesystem::path& page, const Screen& screen = {});
    // Waits until the JavaScript expression is true. Throws std::runtime_error after 20 seconds.
    void wait_for(const std::string& expression);

    // The value of a JavaScript expression.
    std::string text(const std::string& expression);
    double number(const std::string& expression);
    bool truth(const std::string& expression);
    void run(const std::string& statements);

    // CSS selectors name elements; places are fractions of their width and height. Elements are scrolled into view.
    void move_to(const std::string& selector, double x = 0.5, double y = 0.5);
    void click(const std::string& selector, double x = 0.5, double y = 0.5);
    void drag(const std::string& selector, std::pair<double, double> from, std::pair<double, double> to);
    void turn_wheel(const std::string& selector, double x, double y, double delta);
    // Two fingers that start `before` apart about the element's middle and end `after` apart, fractions of its width.
    void pinch(const std::string& selector, double before, double after);
    // "a", "7", "Enter", "Tab", "ArrowLeft"...
    void press(const std::string& key, bool shift = false);
    void choose(const std::string& selector, const std::string& option);  // of a <select>

    void write_screenshot(const std::filesystem::path& png, bool whole_page = false);

    // What the console, the log and uncaught exceptions told, and what was asked of the network, since open().
    const std::vector<std::string>& errors();
    const std::vector<std::string>& network_requests();

private:
    class Connection;
    std::pair<double, double> place_of(const std::string& selector, double x, double y);
    void mouse(const std::string& type, std::pair<double, double> place, double wheel = 0.0);

    std::unique_ptr<Connection> connection_;
    bool pressed_ = false;
};

}  // namespace plumb
