"""The run of this process: commands, messages and the assertions of a command file ask for it."""

#: a run.study.Study; nothing where no command file runs
study = None

#: name -> command, as command files call them; what objects do with fields is done by commands
commands = {}
