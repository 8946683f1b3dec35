"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.rods.card import read_card as read_card
from linkwright.rods.diagnosis import CardDiagnosis as CardDiagnosis
from linkwright.rods.diagnosis import diagnose_card as diagnose_card
from linkwright.rods.many import RodStrings as RodStrings
from linkwright.rods.many import rod_strings as rod_strings
from linkwright.rods.many_cards import CardDiagnoses as CardDiagnoses
from linkwright.rods.many_cards import diagnose_cards as diagnose_cards
from linkwright.rods.prediction import RodStringMotion as RodStringMotion
from linkwright.rods.prediction import rod_string as rod_string
