// Rows of an array whose columns have names.
#pragma once

// A struct of doubles, with the names of its fields as one text, "newton, cuts, …": those of the columns in Python.
#define RINGLET_ROW(Row, ...)                                                                                                  \
    struct Row {                                                                                                               \
        double __VA_ARGS__;                                                                                                    \
        static constexpr const char *columns = #__VA_ARGS__;                                                                   \
    }
