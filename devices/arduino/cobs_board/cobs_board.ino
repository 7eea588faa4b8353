// Reference board for docs/cobs_protocol.md: two analogue inputs at 200 Hz.
// Any Arduino core with a 32-bit micros(); on a board with native USB the baud rate has no meaning.

static const uint8_t FIELDS = 2;
static const uint8_t PINS[FIELDS] = {A0, A1};
static const uint32_t PERIOD_US = 5000;
static const uint32_t BAUD = 921600;
static const char IDENTITY[] = "rolltank-board 1";

static uint32_t sequence = 0;
static uint32_t next_us = 0;
static uint32_t last_us = 0;
static uint32_t turns = 0;

// CRC-16/IBM-3740: polynomial 0x1021, start 0xFFFF, nothing reflected.
static uint16_t crc16(const uint8_t *bytes, uint8_t n) {
  uint16_t crc = 0xFFFF;
  for (uint8_t i = 0; i < n; i++) {
    crc ^= (uint16_t)bytes[i] << 8;
    for (uint8_t bit = 0; bit < 8; bit++) {
      crc = crc & 0x8000 ? (crc << 1) ^ 0x1021 : crc << 1;
    }
  }
  return crc;
}

// Stuffs and sends; a payload here is far below 254 bytes, so no block is ever full.
static void send_frame(uint8_t *payload, uint8_t n) {
  uint16_t crc = crc16(payload, n);
  payload[n++] = crc & 0xFF;
  payload[n++] = crc >> 8;
  uint8_t out[100];
  uint8_t at = 1, code_at = 0, code = 1;
  for (uint8_t i = 0; i < n; i++) {
    if (payload[i] == 0) {
      out[code_at] = code;
      code_at = at++;
      code = 1;
    } else {
      out[at++] = payload[i];
      code++;
    }
  }
  out[code_at] = code;
  out[at++] = 0;
  Serial.write(out, at);
}

static void put32(uint8_t *at, uint32_t value) {
  for (uint8_t i = 0; i < 4; i++) at[i] = value >> (8 * i);
}

static void send_identity() {
  uint8_t payload[70] = {1, 2};
  uint8_t n = strlen(IDENTITY);
  memcpy(payload + 2, IDENTITY, n);
  send_frame(payload, 2 + n);
}

static void send_samples(uint32_t now_us) {
  if (now_us < last_us) turns++;
  last_us = now_us;
  uint8_t payload[15 + 4 * FIELDS + 2] = {1, 1};
  put32(payload + 2, sequence++);
  put32(payload + 6, now_us);
  put32(payload + 10, turns);
  payload[14] = FIELDS;
  for (uint8_t i = 0; i < FIELDS; i++) put32(payload + 15 + 4 * i, (int32_t)analogRead(PINS[i]));
  send_frame(payload, 15 + 4 * FIELDS);
}

void setup() {
  Serial.begin(BAUD);
  send_identity();
  next_us = micros();
}

void loop() {
  // Any byte of a question ends with the zero of its frame; nothing else is ever asked.
  while (Serial.available()) {
    if (Serial.read() == 0) send_identity();
  }
  uint32_t now_us = micros();
  if ((int32_t)(now_us - next_us) < 0) return;
  next_us += PERIOD_US;
  send_samples(now_us);
}
