# How the program answers a call, whatever the subcommand.
# shellcheck shell=bash

case_ "no subcommand is a bad call"
run
expect_failure 2
expect_error 'brume --help'
expect_no_files

case_ "an unknown subcommand is a bad call"
run nonsense --output x.png
expect_failure 2
expect_error '^brume: nonsense: there is no such subcommand'
expect_no_files

case_ "an unknown option is a bad call"
run --nonsense
expect_failure 2
expect_error '^brume: --nonsense: there is no such option'
expect_no_files

case_ "a misspelt option is told the one that was meant"
run render sample:cloud --output a.png --albdeo 1
expect_failure 2
expect_error '^brume: --albdeo: there is no such option, perhaps --albedo: see brume render --help$'
run render sample:cloud --output a.png --sky_radiance=1,1,1
expect_failure 2
expect_error 'perhaps --sky-radiance'
expect_no_files

case_ "--help is an answer, not an error"
run --help
expect_success
expect_output '^Usage: brume'
expect_output '[-][-]version'

case_ "--version"
run --version
expect_success
expect_output '^brume [0-9]+\.[0-9]+\.[0-9]+$'
