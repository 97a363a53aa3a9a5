"""The commands as a command file calls them: check the keywords, then order the operator or do the work here."""

import pathlib
import time

from ..base import before, command_files, orders
from ..commands.call import Call
from ..commands.implementations import implementation, prepared
from ..core import catalog, checker, current, labels, plugins, streams
from ..core.concepts import CO, Concept, _F
from ..core.messages import AsterError, InternalError, fail, message
from ..objects.fields import Field
from . import unused_contacts
from .contact_methods import refuse_other_methods


class Command:
    """A command of the catalogue."""

    def __init__(self, name):
        self.name = name
        self.__name__ = name

    def __repr__(self):
        return f"<command {self.name}>"

    @property
    def __doc__(self):
        return catalog.help_of(catalog.command(self.name))

    def __call__(self, *args, **given):
        with current.turn:
            return self._do(args, given)

    def _do(self, args, given):
        started = time.perf_counter()
        run = current.study
        if run is None:
            raise RuntimeError("commands run in a command file: lacon study.comm")
        frame = labels.user_frame()
        where = labels.location(frame)
        row = plugins.command(self.name)
        if args:
            fail("COMMAND_1", f"{self.name}, {where}", command=self.name)
        starts = self.name in ("DEBUT", "POURSUITE")
        if not starts and not run.open:
            fail("STUDY_12" if run.ended else "STUDY_11", where, command=self.name, ended=run.ended)
        if not starts and run.names.update_labels(run.base):
            run.base.write(where)
        if starts and isinstance(given.get("CODE"), dict):  # until version 14: CODE=_F(NIV_PUB_WEB='INTERNET')
            given["CODE"] = "OUI"
        reuse, identifier = given.pop("reuse", None), given.pop("identifier", None)  # the second one is AsterStudy's number of the command
        given = _with_concepts(given)
        if self.name == "DEFI_CONTACT":
            refuse_other_methods(self.name, given, where, labels.label(frame))
        keywords, problems, alarms = checker.complete(self.name, row, given, where)
        if identifier is not None:
            problems += checker.problems_of(f"{self.name}/identifier", {"type": "text"}, identifier, where)
        reused = self._reuse(row, reuse, given, keywords, where, problems)
        holder, named = next(((k, keywords[k]) for k, keyword in row.get("keyword", {}).items() if keyword.get("makes") and k in keywords), ("", None))
        if isinstance(named, CO) and (taken := run.names.taken(named.name, named)) is not None:
            found = f"{named.name} = {taken!r:.60}"
            path = f"{self.name}/{holder}"
            problems.append(message("KEYWORD_16", f"{path}, {where}", path=path, found=found, expected="CO('name')"))
        if problems:
            raise AsterError(problems)
        run.tell(alarms)
        label = reused.label if reused else named.name if named else labels.label(frame)
        keywords = prepared(Call(run, self.name, keywords, where, label, reused))
        if not self.name.startswith("TEST_"):  # its checks print a line each
            run.progress(f"{where}: {label + ' = ' if label else ''}{self.name}")
        if run.check and run.check.takes(self.name, row, keywords, where):
            result = self._unsolved(run, row, keywords, where, label, reused, named)
            unused_contacts.note(run, self.name, row, keywords, where, result)
            return result
        if "operator" in row:
            result, outcome = self._order(run, row, keywords, where, label, reused, named)
            run.timings.add(self.name, where, time.perf_counter() - started, outcome)
            run.count_alarms(outcome.messages)
            if outcome.log_lost:
                streams.refuse_lost_log()
        else:
            result = implementation(self.name)(Call(run, self.name, keywords, where, label, reused))
            if isinstance(result, Concept):
                _enter(run, label, result, where)
            run.timings.add(self.name, where, time.perf_counter() - started)
        unused_contacts.note(run, self.name, row, keywords, where, result)
        return result

    def _reuse(self, row, reuse, given, keywords, where, problems):
        """The concept to enrich, or nothing."""
        path = f"{self.name}/reuse"
        place = f"{path}, {where}"
        holder = row.get("reuse")
        if reuse is None:
            if row.get("reuse_status") == "mandatory":
                problems.append(message("COMMAND_2", place, keyword=holder))
            return None
        if holder is None:
            problems.append(message("COMMAND_3", place, command=self.name))
        elif wrong := checker.problems_of(path, row["keyword"][holder], reuse, where):
            problems += wrong
        elif keywords.get(holder) is not reuse and holder in given:
            problems.append(message("COMMAND_9", place, keyword=holder))
        return reuse if isinstance(reuse, Concept) else None

    def _order(self, run, row, keywords, where, label, reused, named=None):
        """Have the operator run, and enter its result: under a new object, `reused`, or the CO object `named`."""
        units = self._units(run, row, keywords, where)
        written = {unit for unit in units if unit in run.written_units}
        result = None
        if "result" in row:
            kind = _kind(row, keywords)
            identifier = reused.id if reused else run.base.new_id(kind)
            result = {"id": identifier, "label": label, "reuse": bool(reused)}
            keywords = {k: {"concept": identifier} if named and v is named else v for k, v in keywords.items()}
        made = orders.order(self.name, run, keywords, where, result, units, written)
        key = None
        if result and not any(keyword["unit"] == "out" for _, keyword in _unit_numbers(row, keywords)):
            key = self._key(run, row, made, identifier if reused else None)
            found = self._unchanged(run, kind, key, where, identifier, reused)
            if found:
                if row.get("solves"):
                    run.base.unfinished.replace_failed(found, label)
                self._protect_data(run, row, keywords, units)
                return self._result(run, found, label, where, reused, named), orders.Outcome(0, [], {}, {}, 0.0)
        grows, ended_well = row.get("solves"), False
        if grows:
            run.check_outputs(where)
            identifier = self._resume(run, kind, key, identifier, reused, result)
        copy = before.keep(run.base, identifier) if reused else None
        if grows:
            at = run.base.kept.hold(identifier) if reused else None
            run.base.unfinished.begin(identifier, label, key, at, where, resumes="resume" in result)
            command_files.keep(run.base, identifier, run.texts)
        try:
            outcome = orders.run(row["operator"], made, run)
            if outcome.status != 0:
                orders.raise_failure(outcome, row["operator"], where)
            if result and not run.base.path(identifier).exists():
                how = f"it ended well, and the concept {identifier} is not there"
                raise InternalError([message("INTERNAL_3", where, program=row["operator"], how=how)])
            ended_well = True
            if run.alarm_is_error:
                run.count_alarms(outcome.messages)
        except BaseException:
            if grows and not ended_well and before.has_changed(run.base, identifier, copy):
                self._keep_part(run, identifier, label, where, reused)
            elif result:
                _give_up(run.base, result, copy)
            run.base.drop_partial()
            raise
        if copy:
            run.base.kept.enter_next(identifier, copy, key, outcome.messages)
        elif result:
            run.base.kept.enter(identifier, key, outcome.messages)
        if grows:
            run.base.unfinished.end(identifier)
        self._protect_data(run, row, keywords, units)
        self._take_written(run, row, keywords, units)
        if not result:
            return None, outcome
        item = self._result(run, identifier, label, where, reused, named)
        if copy:
            copy.unlink()  # the registry tells now what the concept holds
        if grows:
            run.base.unfinished.drop_record(identifier)
        return item, outcome

    def _key(self, run, row, made, changed):
        """What tells whether an order is the same as an earlier one. @param changed id of the concept that it changes, or None"""
        def make_key():
            return run.base.kept.order_key(made, plugins.operator_folder() / row["operator"], made["units"])

        return run.base.kept.key_of_change(changed, make_key) if changed else make_key()

    def _take_written(self, run, row, keywords, units):
        """Files that the operator has written: of the unit of messages they are printed, others are the study's."""
        for number, keyword in _unit_numbers(row, keywords):
            if keyword["unit"] != "out":
                continue
            if self._is_printed(run, number, keywords):
                printed = pathlib.Path(units[number])
                print(printed.read_text(encoding="utf-8"), end="")
                printed.unlink()
            else:
                run.written_units[number] = units[number]

    def _resume(self, run, kind, key, identifier, reused, result):
        """Have the operator go on where a run with the same order was ended. @return the id of the concept"""
        found = run.base.unfinished.find(kind, key)
        if found is None or (reused and found != identifier):
            return identifier
        if not reused:
            run.base.give_back(identifier)
        result.update(id=found, resume=True)
        return found

    def _keep_part(self, run, identifier, label, where, reused):
        """A computation ended on the way: the instants before that are there, under the name that the result was to have."""
        run.base.kept.leave(identifier)
        item = self._result(run, identifier, label, where, reused, None)
        if label.isidentifier():
            run.names.values[label] = item
        run.inform("COMMAND_14", f"{self.name}, {where}", label=label or identifier)

    def _protect_data(self, run, row, keywords, units):
        """The files that the command has read are data of the study."""
        for number, keyword in _unit_numbers(row, keywords):
            if keyword["unit"] == "in":
                run.has_read(units[number])

    def _result(self, run, identifier, label, where, reused, named):
        """The object of a concept that is there now, in the registry and under the names it was given."""
        if named:
            named.become(run.base, identifier)
            run.names.publish(label, named)
        item = reused or run.base.concept(identifier, label)
        _enter(run, label, item, where)
        return item

    def _unsolved(self, run, row, keywords, where, label, reused, named):
        """The object of a concept that `lacon check` does not make; nothing for a command without. The operator of one that solves
        does all but that, where what it starts from was really made."""
        if "result" not in row:
            return None
        identifier = reused.id if reused else run.base.new_id(_kind(row, keywords))
        if run.check.prepares(row, keywords):
            run.check_outputs(where)
            result = {"id": identifier, "label": label, "reuse": bool(reused)}
            made = orders.order(self.name, run, keywords, where, result, self._units(run, row, keywords, where))
            outcome = orders.run(row["operator"], made, run, checks=True)
            if outcome.status != 0:
                orders.raise_failure(outcome, row["operator"], where)
        run.base.unsolved = {**dict(run.base.unsolved), identifier: (label or self.name, where)}
        return self._result(run, identifier, label, where, reused, named)

    def _unchanged(self, run, kind, key, where, identifier, reused):
        """The id of the concept, where an earlier run made it from the same; its alarms are said again."""
        kept, silent = run.base.kept, run.alarm_is_error
        if reused:
            found = identifier if kept.find_next(identifier, key, silent) else None
        else:
            found = kept.find(kind, key, silent)
        if not found:
            return None
        if not reused:
            run.base.give_back(identifier)
        run.progress("  unchanged since it was made: kept")
        run.repeat_alarms(kept.alarms(found), where)
        return found

    def _units(self, run, row, keywords, where):
        """Files of the units that the keywords name."""
        units = {}
        for number, keyword in _unit_numbers(row, keywords):
            place = f"{self.name}/UNITE, {where}"
            if keyword["unit"] == "in":
                units[number] = run.input_unit(number, place)
            elif self._is_printed(run, number, keywords):
                units[number] = str(run.base.orders() / "printed")
            else:
                form = keywords.get("FORMAT")
                units[number] = run.announced_output(number, {"MED": ".med", "VTU": ".pvd", "RESULTAT": ".resu"}.get(form, ""), place)
                run.enter_format(number, units[number], form, place)
        return units

    @staticmethod
    def _is_printed(run, number, keywords):
        """Whether the operator writes text for the terminal, which the launcher prints."""
        return run.is_terminal(number) and keywords.get("FORMAT") == "RESULTAT"


def _with_concepts(value):
    """Keywords with concepts in the place of fields of results, R.getField('DEPL', 1)."""
    if isinstance(value, Field):
        return value.concept()
    if isinstance(value, dict):
        return {name: _with_concepts(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)) and any(isinstance(item, (Field, dict)) for item in value):
        return [_with_concepts(item) for item in value]
    return value


def _kind(row, keywords):
    """The type of what a command makes: `result`, or that of the concept which the keyword `result_of` holds."""
    given = keywords.get(row.get("result_of"))
    return given.type if given is not None else row["result"]


def _unit_numbers(row, keywords):
    return [(keywords[name], keyword) for name, keyword in row.get("keyword", {}).items() if "unit" in keyword and name in keywords]


def _enter(run, label, item, where):
    """Enter a concept that is there now in the registry, under the variable it is about to be assigned to."""
    run.names.update_labels(run.base, (label, item.id))
    run.base.write(where)


def _give_up(base, result, copy):
    """The operator has failed, and left nothing: the concept that it changes is as it was, and the id of a new one is free again, unless a failed
    step is kept under it. @param copy before.keep() of the concept that it changes, or None"""
    identifier = result["id"]
    if copy:
        before.put_back(base, identifier, copy)
        if not result.get("resume"):
            base.unfinished.end(identifier)
    elif not base.failed_step(identifier).exists():
        base.give_back(identifier)


class Unavailable:
    """A command of code_aster that Lacon does not have."""

    def __init__(self, name):
        self.name = name

    def __call__(self, *args, **given):
        frame = labels.user_frame()
        if self.name == "DEFI_CONT":
            refuse_other_methods(self.name, given, labels.location(frame), labels.label(frame))
        instead = catalog.instead("command", self.name, catalog.part("see_commands"))
        fail("COMMAND_11", labels.location(frame), command=self.name, instead=instead)


def all_commands():
    """name -> callable: every command, and every name of code_aster's that is not one here. Objects find them in core/current.py."""
    names = {name: Unavailable(name) for name in catalog.peer_commands()}
    names.update((name, Command(name)) for name in catalog.command_names())
    current.commands = dict(names)
    names.update(_F=_F, CO=CO)
    return names
