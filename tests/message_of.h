// The message of the exception that a call throws.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace plumb {

template <class Error, class Function>
std::string message_of(Function&& function) {
    try {
        function();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

}  // namespace plumb
