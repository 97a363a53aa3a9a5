"""DEBUT, POURSUITE, FIN; DETRUIRE."""


def debut(call):
    call.study.start(call.keywords, call.where, resume=False)


def poursuite(call):
    call.study.start(call.keywords, call.where, resume=True)


def fin(call):
    call.study.finish(call.where)


def detruire(call):
    items = call.keywords.get("NOM", []) + [c for factor in call.keywords.get("CONCEPT", []) for c in factor["NOM"]]
    call.study.destroy(items, call.where)
