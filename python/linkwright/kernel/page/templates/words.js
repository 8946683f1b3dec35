// What the page says in its language: `say(text, …)` with its numbers in place of #, and the decimal sign.
const WORDS = JSON.parse(document.getElementById("words").textContent);
const decimal = (text) => String(text).replace(".", WORDS.decimal);
const say = (text, ...numbers) => (WORDS.texts[text] ?? text).replace(/#/g, () => decimal(numbers.shift()));
