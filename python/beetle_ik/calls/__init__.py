"""Arguments, messages and progress of calls in Python and in the native module.

arguments   checks of arguments
labelled    numbers with names: messages, dicts, tables
wording     errors of arguments that do not fit, with the argument, its value and what is expected
names       suggestions for misspelt names
attributes  hints for attributes that a value lacks
renamed     keywords under their old names, which warn
text        counts and lists in messages, numbers that read back
warned      warnings that name the line of the program that caused them
progress    the progress bar, and the argument `progress`
"""
