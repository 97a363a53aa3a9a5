"""`lacon NAME ...` that is no study: one module a tool, whose run(arguments) returns the exit status."""
