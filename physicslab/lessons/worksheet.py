"""A lesson as a page to print and to write on: questions, runs and room for answers, and no solutions."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from html import escape

from physicslab.languages.language import Language
from physicslab.lessons import words
from physicslab.lessons.answers import asked
from physicslab.lessons.lesson import Compare, Explain, Lesson, Part, Prose, Question, Recall, Run

_STYLE = """
body { font: 11pt/1.45 sans-serif; max-width: 44em; margin: 1em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0; } h2 { font-size: 1.2em; margin: 1.6em 0 0.4em; }
section { break-inside: avoid; border-left: 3px solid #888; padding-left: 0.8em; margin: 0.9em 0; }
.kind { font-size: 0.85em; color: #444; } .line { border-bottom: 1px solid #888; height: 1.9em; }
ul { list-style: none; padding-left: 0; } table { border-collapse: collapse; }
td, th { border: 1px solid #888; padding: 0.3em 0.6em; text-align: left; }
.box { height: 9em; border: 1px solid #888; }
"""


def worksheet(lesson: Lesson, find: Callable[[str], Lesson]) -> str:
    """Return the page as HTML, which needs nothing beside itself; ``find`` returns earlier lessons."""
    recalled = {name: one for name, _, one, _ in asked(lesson, find) if isinstance(one, Question)}
    body = "\n".join(_body(lesson, recalled))
    return (
        f'<!doctype html>\n<html lang="{escape(lesson.language)}">\n<head><meta charset="utf-8">\n'
        f"<title>{escape(lesson.title)}</title>\n<style>{_STYLE}</style></head>\n<body>\n{body}\n</body>\n</html>\n"
    )


def _body(lesson: Lesson, recalled: Mapping[str, Question]) -> Iterator[str]:
    own, setup = lesson.own, lesson.setup
    yield f"<h1>{escape(lesson.title)}</h1>"
    yield f'<p class="kind">{escape(words.about_words(own, lesson))}</p>'
    yield f"<p>{own.say('Name')}: ______________________________ &nbsp; {own.say('Date')}: ______________</p>"
    yield _row("th", ["", own.say("value"), own.say("may be")], "<table>")
    for name, expression in setup.parameters.items():
        note, span = setup.notes.get(name, ""), setup.opened.get(name)
        may = own.say("{least} to {most}", least=span[0], most=span[1]) if span else ""
        symbol = words.formula(own, name)
        called = f"{symbol}, {note}" if note else symbol
        yield _row("td", (called, words.formula(own, expression.text), words.formula(own, may)))
    yield "</table>"
    for step in lesson.steps:
        if step.heading:
            yield f"<h2>{step.depth} · {escape(step.heading)}</h2>"
        for part in step.parts:
            yield from _part(part, recalled, own)
    if lesson.sources:
        yield f"<h2>{own.say('Sources')}</h2><ul>"
        yield from (f"<li>[{escape(key)}] {escape(source)}</li>" for key, source in lesson.sources.items())
        yield "</ul>"


def _row(cell: str, texts: Iterable[str], before: str = "") -> str:
    return f"{before}<tr>{''.join(f'<{cell}>{escape(text)}</{cell}>' for text in texts)}</tr>"


def _part(part: Part, recalled: Mapping[str, Question], own: Language) -> Iterator[str]:
    """Yield a part, with room for what is to be written."""
    match part:
        case Prose(text=text):
            yield from (f"<p>{escape(one)}</p>" for one in text.split("\n\n"))
            return
        case Question():
            kind, inner = part.kind, [f"<p>{escape(part.prompt)}</p>", *_room(part, own)]
            if kind == "predict":
                marks = " · ".join(f"□ {word}" for word in words.sureness_words(own).values())
                inner.append(f'<p class="kind">{escape(own.say("How sure?"))} {escape(marks)}</p>')
        case Run():
            kind, said = "run", words.run_words(own, part)
            inner = [f"<p>{escape(said)} {escape(own.say('What do you see?'))}</p>", *_lines(2)]
        case Compare():
            kind, (theory, holds, heads) = "compare", words.compare_words(own, part)
            cases = [(words.case_words(own, case, noted=False), *"    ") for case in part.cases + part.fails]
            inner = [
                f"<p>{escape(theory)} &nbsp; <span class='kind'>{escape(holds)}</span></p>",
                _row("th", heads, "<table>"), *(_row("td", cells) for cells in cases), "</table>",
            ]  # fmt: skip
        case Explain():
            kind, inner = "explain", [f"<p>{escape(part.prompt)}</p>", *_lines(4)]
        case Recall():
            kind, inner = "recall", []
            for lesson, name in part.asks:
                question = recalled[f"{lesson}/{name}"]
                inner += [f"<p>{escape(question.prompt)}</p>", *_room(question, own)]
    yield f'<section><div class="kind">{words.kind_words(own)[kind]}</div>'
    yield from inner
    yield "</section>"


def _room(question: Question, own: Language) -> Iterator[str]:
    """Yield what an answer is marked in or written on."""
    unit = words.unit_words(own, question.unit)
    if question.form == "choice":
        yield "<ul>"
        yield from (f"<li>□ {escape(reply.text)}</li>" for reply in question.replies)
        yield "</ul>"
    elif question.form == "curve":
        yield f'<div class="box">{escape(own.say("{unit} over time", unit=unit))}</div>'
    elif question.form == "number":
        yield f"<p>______________ {escape(unit)}</p>"
    else:
        yield from _lines(1)


def _lines(number: int) -> list[str]:
    return ['<div class="line"></div>'] * number
